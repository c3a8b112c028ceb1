// Springs, vessels and joins as JSON, of a Scene and of a SceneSpec. Internal to the scene room.
#pragma once
#include <nlohmann/json.hpp>
#include <vector>

#include "scene/described_keys.h"

namespace pliant {

template <class S>
nlohmann::ordered_json spring_json(const S& s) {
  nlohmann::ordered_json spring;
  describe_spring(WriteKeys{spring}, s);
  if (!s.curve.empty()) spring["table"] = s.curve;
  return spring;
}

template <class T>
nlohmann::ordered_json vessel_json(const T& t) {
  nlohmann::ordered_json vessel{{"points", t.points}};
  if (!t.segments.empty()) vessel["segments"] = t.segments;
  describe_vessel(WriteKeys{vessel}, t);
  return vessel;
}

/// Rows are as short as they can be; a factor that is not there is 1, a length 0.
template <class L>
nlohmann::ordered_json spring_list_json(const L& list) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < list.nodes.size(); ++s) {
    nlohmann::ordered_json row = list.nodes[s];
    const double factor = s < list.factor.size() ? list.factor[s] : 1, length = s < list.length.size() ? list.length[s] : 0;
    if (factor != 1 || length != 0) row.push_back(factor);
    if (length != 0) row.push_back(length);
    rows.push_back(std::move(row));
  }
  return {{"nodes", std::move(rows)}, {"spring", spring_json(list.spring)}};
}

template <class J>
void add_joins(nlohmann::ordered_json& top, const std::vector<J>& joins) {
  for (const J& j : joins) {
    nlohmann::ordered_json join{{"bodies", j.bodies}};
    describe_join(WriteKeys{join}, j);
    join["spring"] = spring_json(j.spring);
    top["joins"].push_back(join);
  }
}

}  // namespace pliant
