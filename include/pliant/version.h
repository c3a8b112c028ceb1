// The version of Pliant, the only place where it is written: CMake reads it from here. Semantic versioning (semver.org, 2.0.0).
#pragma once

#define PLIANT_VERSION_MAJOR 0
#define PLIANT_VERSION_MINOR 1
#define PLIANT_VERSION_PATCH 0
