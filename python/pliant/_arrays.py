"""Arrays over memory of the engine: see "Arrays" in docs/embedding.md."""
import numpy as np


class _Writable:
    """The memory of a read-only array, described as writable; it keeps the array."""

    def __init__(self, array):
        self.__array_interface__ = {**array.__array_interface__, "data": (array.__array_interface__["data"][0], False)}
        self.array = array


class FrameArray(np.ndarray):
    """A read-only NumPy view of a Frame, which it keeps. What is computed from it is a plain NumPy array.

    Unlike a read-only array of NumPy it can be exported by DLPack to every consumer: to one that knows DLPack 1.0 as read-only, to an older one,
    whose protocol has no word for that, as memory which it must not write to.
    """

    def __array_wrap__(self, array, context=None, return_scalar=False):
        return array[()] if return_scalar or np.ndim(array) == 0 else np.asarray(array)

    def __repr__(self):
        return repr(np.asarray(self))

    def __dlpack__(self, **options):
        if self.flags.writeable:  # a copy
            return super().__dlpack__(**options)
        if options.get("max_version") or options.get("copy"):
            try:
                return super().__dlpack__(**options)
            except TypeError:  # NumPy before 2.1 has neither word
                if options.get("copy"):
                    return np.array(self).__dlpack__()
            except BufferError:  # a consumer of DLPack 0
                if options.get("copy"):
                    raise
        return np.asarray(_Writable(self)).__dlpack__(stream=options.get("stream"))
