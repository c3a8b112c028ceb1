// What a shared library shows of itself: everything else is hidden.
#pragma once

#if defined(_WIN32)
#define PLIANT_API
#else
#define PLIANT_API __attribute__((visibility("default")))
#endif
