// Results of the probes of a scene (key "probes" in docs/scene.md).
#pragma once
#include <string>
#include <vector>

namespace pliant {

/// One quantity of one probe at one time.
struct ProbeValue {
  std::string probe;            ///< name of the probe in the scene
  std::string quantity;         ///< position, displacement, velocity, stress, reaction, force or energy
  std::vector<double> numbers;  ///< x, y, z [m], [m/s] or [N]; stress: xx, yy, zz, xy, yz, zx [Pa], NaN where the element is
                                ///< inverted and its law is undefined there; energy: kinetic, strain [J]
};

}  // namespace pliant
