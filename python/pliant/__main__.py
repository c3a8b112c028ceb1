"""python -m pliant SCENE.json opens a scene in the browser, python -m pliant convert IN OUT converts meshes, stages and results."""
import argparse
import sys

import pliant
from pliant import view
from pliant._codes import exit_code


def main():
    if sys.argv[1:2] == ["convert"]:
        from pliant.convert import _command

        return _command.main(sys.argv[2:])
    parser = argparse.ArgumentParser(prog="python -m pliant", description="Opens a scene in the browser. `python -m pliant convert --help` converts.")
    parser.add_argument("scene", help="a scene file")
    parser.add_argument("--backend", default="auto", help="as `pliant devices` names them (auto)")
    parser.add_argument("--port", type=int, default=8080, help="the next free one is taken from here on (8080)")
    parser.add_argument("--host", default="127.0.0.1", help="the address that is listened on; 0.0.0.0: every machine may look, and steer (127.0.0.1)")
    parser.add_argument("--pause", action="store_true", help="wait for the button")
    options = parser.parse_args()
    return exit_code(lambda: _open(options))


def _open(options):
    view.need_viser()
    world = pliant.World(options.scene, backend=options.backend, interactive=True, cutting=True)
    world.show(options.port, host=options.host, play=not options.pause)


if __name__ == "__main__":
    sys.exit(main())
