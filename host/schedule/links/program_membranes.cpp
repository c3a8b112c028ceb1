// Buffers and pass of a body's membrane.
#include <fmt/format.h>

#include <algorithm>

#include "schedule/program_builder.h"

namespace pliant {

void ProgramBuilder::add_membrane(const Links& links, std::size_t index, std::int32_t base, LinkForces& forces) {
  const MembraneBatch& b = links.membranes[index];
  const auto count = static_cast<std::size_t>(padded(b.size()));
  constexpr std::size_t planes = PLIANT_MEMBRANE_DATA_PLANES;
  std::vector<std::int32_t> corners(3 * count);
  std::vector<double> data(planes * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t t = std::min(i, b.size() - 1);  // padding repeats the last one, whose copies nobody gathers
    for (std::size_t a = 0; a < 3; ++a) corners[tile_base(i, 3) + a * PLIANT_TILE] = link_place_[b.points[t][a]];
    for (std::size_t k = 0; k < planes; ++k) data[tile_base(i, planes) + k * PLIANT_TILE] = b.records[t][k];
  }
  for (std::size_t t = 0; t < b.size(); ++t) {
    const std::int32_t texel = base + static_cast<std::int32_t>(tile_base(t, 3));
    for (std::int32_t a = 0; a < 3; ++a) {
      // The triangle's force on its corner is the opposite of V P grad N.
      forces[static_cast<std::size_t>(b.points[t][static_cast<std::size_t>(a)])].push_back({texel + a * PLIANT_TILE, -1});
    }
  }
  const auto points_id =
      add(make_ints(fmt::format("membrane_points/{}", index), BufferRole::constant, "[tiles][3][16]", std::move(corners)));
  const auto data_id = add(make_reals(fmt::format("membrane_data/{}", index), BufferType::real, planes * count,
                                      BufferRole::constant, "[tiles][10][16]", "1, 1/m, m^3", "model", std::move(data)));
  program_.step.push_back({"membrane_force",
                           {},
                           {buffer_arg(link_u_), buffer_arg(points_id), buffer_arg(data_id), buffer_arg(link_force_),
                            real_arg(b.law.stiffness()), real_arg(b.law.poisson), int_arg(base)},
                           Shape::lanes,
                           static_cast<std::int64_t>(count),
                           b.label,
                           static_cast<std::int64_t>(b.size()),
                           12 + 4.0 * planes + 48 + 16.0 * double(links.points.size()) / double(b.size()),
                           115});
}

}  // namespace pliant
