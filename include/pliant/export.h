/* Visibility of symbols in the shared library: only those marked PLIANT_API are exported. Valid C. */
#ifndef PLIANT_EXPORT_H
#define PLIANT_EXPORT_H

#if defined(_WIN32)
#define PLIANT_API
#define PLIANT_HIDDEN
#else
#define PLIANT_API __attribute__((visibility("default")))
#define PLIANT_HIDDEN __attribute__((visibility("hidden")))
#endif

#endif
