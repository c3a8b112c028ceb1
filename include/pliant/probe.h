// Results of the probes of a scene (key "probes" in docs/scene.md).
#pragma once
#include <string>
#include <vector>

namespace pliant {

/// One quantity of one probe at one time.
struct ProbeValue {
  std::string probe;            ///< name of the probe in the scene
  std::string quantity;         ///< position, displacement, velocity, stress, green_strain, almansi_strain, reaction, force,
                                ///< energy or interpenetration
  std::vector<double> numbers;  ///< x, y, z [m], [m/s] or [N]; stress [Pa] and strains: xx, yy, zz, xy, yz, zx, NaN where the
                                ///< element is inverted and they are undefined there; energy: kinetic, strain [J];
                                ///< interpenetration: volume [m^3], centroid [m], two areas [m^2], depth, deepest point [m],
                                ///< as in Interpenetration, NaN where there is no such point
};

}  // namespace pliant
