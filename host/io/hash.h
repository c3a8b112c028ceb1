// The hash lives beside the buffers it is mostly used on.
#pragma once
#include "state/hash.h"
