#include "cli/probes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "io/atomic_file.h"
#include "pliant/error.h"

namespace pliant::cli {
namespace {

/// The names of a quantity's columns, with units.
const char* header(Quantity quantity) {
  switch (quantity) {
    case Quantity::position:
      return ",x [m],y [m],z [m]";
    case Quantity::displacement:
      return ",ux [m],uy [m],uz [m]";
    case Quantity::velocity:
      return ",vx [m/s],vy [m/s],vz [m/s]";
    case Quantity::stress:
      return ",sxx [Pa],syy [Pa],szz [Pa],sxy [Pa],syz [Pa],szx [Pa]";
    case Quantity::green_strain:
      return ",Exx,Eyy,Ezz,Exy,Eyz,Ezx";
    case Quantity::almansi_strain:
      return ",exx,eyy,ezz,exy,eyz,ezx";
    case Quantity::reaction:
      return ",rx [N],ry [N],rz [N]";
    case Quantity::force:
      return ",fx [N],fy [N],fz [N]";
    case Quantity::energy:
      return ",kinetic [J],strain [J]";
    case Quantity::interpenetration:
      return ",volume [m^3],centroid x [m],centroid y [m],centroid z [m],area of the first [m^2],area of the second "
             "[m^2],depth [m],deepest x [m],deepest y [m],deepest z [m]";
  }
  return "";
}

std::string columns(const ProbeState& state, Quantity quantity) {
  return fmt::format(",{:.9g}", fmt::join(state.numbers(quantity), ","));
}

}  // namespace

SceneProbe parse_probe(const std::string& text) {
  const auto refuse = [&](const char* what) {
    throw Error(
        ErrorCode::bad_input,
        fmt::format("--probe is \"{}\": {}; expected NAME=x,y,z with a point at rest in m, such as tip=0,0.05,0", text, what));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse("there is no name");
  SceneProbe point;
  point.name = text.substr(0, equals);
  point.pointer = "--probe " + point.name;
  point.quantities = {Quantity::position, Quantity::displacement, Quantity::velocity};
  Vec3d rest{};
  if (point.name.find_first_of(",\"\n\r") != std::string::npos) refuse("a name has no comma, quotation mark or line break");
  const char *at = text.data() + equals + 1, *end = text.data() + text.size();
  for (std::size_t a = 0; a < 3; ++a) {
    const auto read = std::from_chars(at, end, rest[a]);
    if (read.ec != std::errc() || !std::isfinite(rest[a])) refuse("three finite numbers are needed");
    at = read.ptr;
    if (a < 2 && (at == end || *at++ != ',')) refuse("three finite numbers are needed");
  }
  if (at != end) refuse("three finite numbers are needed");
  point.point = rest;
  return point;
}

void Probes::write(Simulation& simulation, const std::filesystem::path& file) {
  if (empty() || simulation.step() == last_step_) return;
  last_step_ = simulation.step();
  if (table_.empty()) table_ = "time,step,probe,x,y,z,ux,uy,uz,vx,vy,vz\n";
  const std::vector<ProbeState> now = states(simulation);
  for (std::size_t i = 0; i < now.size(); ++i) {
    table_ += fmt::format("{:.9g},{},{}", simulation.time(), simulation.step(), probe(i).name);
    for (const Quantity q : probe(i).quantities) table_ += columns(now[i], q);
    table_ += '\n';
  }
  write_file(file, table_);
}

void Probes::write_each(Simulation& simulation, const std::filesystem::path& folder, const std::string& stem) {
  if (empty() || simulation.step() == last_step_) return;
  last_step_ = simulation.step();
  const std::vector<ProbeState> now = states(simulation);
  tables_.resize(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    std::string& table = tables_[i];
    if (table.empty()) {
      table = "time [s],step";
      for (const Quantity q : probe(i).quantities) table += header(q);
      table += '\n';
    }
    table += fmt::format("{:.9g},{}", simulation.time(), simulation.step());
    for (const Quantity q : probe(i).quantities) table += columns(now[i], q);
    table += '\n';
    write_file(folder / fmt::format("{}_{}.csv", stem, probe(i).name), table);
  }
}

}  // namespace pliant::cli
