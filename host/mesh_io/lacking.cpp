#include "mesh_io/lacking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace pliant {

namespace {

constexpr Lacking kTable[]{
    {"law", "viscoelastic viscohyperelastic kelvinvoigt maxwell prony quasilinearviscoelastic qlv zener standardlinearsolid",
     "law with a memory (Prony series)", "an elastic law with the key \"viscosity\", a stress of Kelvin and Voigt"},
    {"law", "linear linearelastic hooke hookean corotated corotational fixedcorotated", "linear or corotated law",
     "\"saint-venant-kirchhoff\", which is linear in Green's strain, or \"linear\": true of a static solver"},
    {"law", "ogden arrudaboyce gent fung veronda verondawestmann demiray exponential polynomial", "such hyperelastic law",
     "\"yeoh\", which stiffens at large strain as well, or \"mooney-rivlin\""},
    {"law", "holzapfel holzapfelgasserogden hgo transverselyisotropic orthotropic anisotropic fibre fiber", "anisotropic law",
     "an isotropic law, with \"springs\" of the body between nodes along the fibres"},
    {"law", "plastic elastoplastic vonmises j2 druckerprager", "plastic law",
     "an elastic law with a \"toughness\", beyond which tissue tears"},
    {"law", "poroelastic biphasic poroviscoelastic", "law with a fluid in the pores",
     "a law with a \"poisson\" near 0.5 and the key \"bulk_viscosity\""},
    {"law", "rigid", "rigid body among the bodies", "an entry of \"tools\", or \"fixed\" nodes"},
    {"element", "tet10 quadratictet c3d10", "quadratic tetrahedron in time steps",
     "\"tet4anp\", which does not lock, or \"tet4\" with \"order\": 2 of a static solver"},
    {"element", "hex20 hex27 quadratichex c3d20 c3d8", "such hexahedron",
     "\"hex8full\", or \"hex8\" with one point and hourglass control"},
    {"element", "wedge wedge6 prism pyramid penta6 pyramid5", "wedges and pyramids",
     "tetrahedra, into which a mesher divides them"},
    {"element", "shell membrane quad4 tri3 triangle cloth beam truss spring cable", "element of a surface or a line",
     "a \"membrane\", \"vessels\" or \"springs\" of a body, or a thin body of \"hex8full\" or tetrahedra, two or more across "
     "its thickness"},
    {"integrator", "newmark implicit impliciteuler backwardeuler bdf2 hht generalizedalpha cranknicolson trapezoidal midpoint",
     "implicit integrator",
     "\"increment\" (explicit central differences with an automatic step), and for rest \"relaxation\" or a static solver"},
    {"integrator",
     "verlet velocityverlet leapfrog centraldifferences centraldifference explicit symplecticeuler semiimpliciteuler",
     "integrator of this name", "\"increment\", central differences, which these are as well"},
    {"integrator", "rk2 rk4 rungekutta", "integrator of several stages", "\"increment\", of second order"},
    {"integrator", "euler expliciteuler", "integrator of this name", "\"forward-euler\", which is explicit Euler"},
    {"model/type", "xpbd pbd projectivedynamics", "model of positions",
     "\"flsm\", shape matching, or \"tled\", finite elements"},
    {"model/type", "springs network massspringdamper", "model of this name", "\"mass-spring\""},
    {"model/type", "fem finiteelements nonlinear elements meshless mpm sph efg modal reduced", "model of this name",
     "\"tled\", finite elements with the total Lagrangian formulation"},
    {"solver/type", "implicit quasistatic newton newtonraphson linear", "solver of this name",
     "\"static\", Newton and Raphson's method, with \"linear\": true for small displacements"},
    {"solver/type", "explicit transient", "solver of this name", "\"dynamic\", steps in time"},
    {"curve", "sine sinus sinusoidal cosine harmonic periodic triangle spline", "such curve",
     "a \"table\" of times and factors, linear in between"},
    {"curve", "linear", "curve of this name", "\"ramp\""},
    {"curve", "step heaviside", "curve of this name", "\"constant\", or a \"table\""},
    {"key of material", "prony relaxationtime relaxationtimes tau", "law with a memory (Prony series)",
     "\"viscosity\" and \"bulk_viscosity\", a stress of Kelvin and Voigt"},
    {"key of material", "rayleighalpha rayleighbeta rayleigh", "Rayleigh damping of these names",
     "\"damping\", its part proportional to mass, and \"stiffness_damping\" for the other one"},
    {"key of material", "fibre fiber fibres fibers fibredirection fiberdirection", "anisotropic law",
     "an isotropic law, with \"springs\" of the body between nodes along the fibres"},
    {"key of material", "yieldstress plasticity hardening", "plastic law",
     "\"toughness\", the stress beyond which tissue tears"},
    {"key of body", "rigid attachments links joints", "joints or rigid bodies",
     "\"springs\" between its nodes, \"joins\" of the scene, \"fixed\" and \"prescribed\" nodes, or an entry of \"tools\""},
    {"key of scene", "rigidbodies obstacles colliders floor ground table", "rigid bodies of this name",
     "\"tools\", which may stand still (a \"half_space\" is a table)"},
    {"key of scene", "fluid fluids blood", "such thing", "\"bodies\" and \"tools\""},
    {"key of scene", "cloth sheets membranes", "list of this name", "\"bodies\" with a \"thickness\" or a \"membrane\""},
    {"key of scene", "joints cables", "list of this name", "\"joins\" between bodies, \"vessels\" and \"springs\" of a body"},
    {"key of shape", "cylinder cone torus ellipsoid", "shape of this name", "\"capsule\", or a closed \"mesh\""},
    {"key of shape", "plane ground floor", "shape of this name", "\"half_space\""},
    {"key of shape", "cube cuboid", "shape of this name", "\"box\", by its edges"},
    {"surface", "msh vtk vtu node ele", "surfaces in files of volume meshes",
     "the key \"mesh\", which takes the tetrahedra or hexahedra of such a file"},
    {"surface", "step stp iges igs sldprt brep fcstd catpart", "reader of CAD models",
     "triangles that the CAD program exports as STL or OBJ"},
    {"surface", "dcm dicom nii nrrd mha mhd tif tiff", "segmentation of images",
     "the surface that a segmentation program exports as STL or OBJ"},
    {"surface", "usd usda usdc usdz vtp", "reader of this format", "OBJ, STL, PLY, 3DS or glTF"},
    {"mesh", "stl obj ply gltf glb 3ds off", "volume in files of surfaces",
     "the key \"surface\", with a \"lattice\" that fills it"},
    {"mesh", "inp bdf nas unv exo e xdmf cgns med mesh meshb feb k", "reader of this format",
     "a conversion to .vtu or .msh, which most meshers and converters write"}};

bool holds(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(' '), list.size());
    if (list.substr(0, end) == word) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

}  // namespace

std::span<const Lacking> lacking_table() { return kTable; }

std::string lacking(std::string_view where, std::string_view word) {
  std::string plain;
  for (const char c : word) {
    if (c != '-' && c != '_' && c != ' ' && c != '.') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (plain.empty()) return "";
  for (const Lacking& entry : lacking_table()) {
    if (entry.where != where || !holds(entry.words, plain)) continue;
    return fmt::format("; this version has no {}: the nearest is {}", entry.missing, entry.nearest);
  }
  return "";
}

}  // namespace pliant
