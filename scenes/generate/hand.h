// A hand that closes, as a sequence of meshes whose topology changes from frame to frame, as a reconstructed hand would arrive.
#pragma once
#include "geometry/mesh.h"

namespace pliant {

inline constexpr int hand_frames = 12;

/// Closed and outward, in metres: the palm about the origin with its inside towards -y, fingers along +x, the thumb at +z, the
/// wrist at -x. Nearly flat in frame 0, half closed in the last one.
TriangleMesh make_hand(int frame);

}  // namespace pliant
