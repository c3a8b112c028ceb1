// What the probes of a scene say: the key "probes" of docs/scene.md.
#pragma once
#include <string>
#include <vector>

namespace pliant {

/// One quantity of one probe at one moment.
struct ProbeValue {
  std::string probe;            ///< its name in the scene
  std::string quantity;         ///< position, displacement, velocity, stress, reaction, force or energy
  std::vector<double> numbers;  ///< x, y, z [m], [m/s] or [N]; stress: xx, yy, zz, xy, yz, zx [Pa], not numbers where the
                                ///< element is inverted and its law ends there; energy: kinetic, of the strain [J]
};

}  // namespace pliant
