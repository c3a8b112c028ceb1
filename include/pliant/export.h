/* What a shared library shows of itself: everything else is hidden. Also C. */
#ifndef PLIANT_EXPORT_H
#define PLIANT_EXPORT_H

#if defined(_WIN32)
#define PLIANT_API
#else
#define PLIANT_API __attribute__((visibility("default")))
#endif

#endif
