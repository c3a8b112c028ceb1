// The whole C++ API. The C API is pliant/c/pliant.h.
#pragma once
#ifndef __cplusplus
#error "pliant/pliant.h is the C++ API; the C API is <pliant/c/pliant.h>"
#endif

#include "pliant/error.h"
#include "pliant/frame.h"
#include "pliant/haptic_device.h"
#include "pliant/haptics.h"
#include "pliant/probe.h"
#include "pliant/scene.h"
#include "pliant/tool.h"
#include "pliant/version.h"
#include "pliant/world.h"
#include "pliant/wrench.h"
