/* The version of Pliant, the only place where it is written: CMake reads it from here. Semantic versioning 2.0.0. Also C. */
#ifndef PLIANT_VERSION_H
#define PLIANT_VERSION_H

#define PLIANT_VERSION_MAJOR 0
#define PLIANT_VERSION_MINOR 1
#define PLIANT_VERSION_PATCH 0

#endif
