// What edits do to state buffers follows from what each of them declares (program/buffer.h).
#include "simulation/state/carried_state.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "schedule/build_program.h"
#include "solver/rich_state.h"

namespace pliant::carried_state_test {
namespace {

Buffer row(const std::string& name, BufferType type, std::size_t count, Carry carry) {
  Buffer buffer;
  buffer.name = name;
  buffer.type = type;
  buffer.count = count;
  buffer.role = BufferRole::state;
  buffer.carry = carry;
  return buffer;
}

TEST(CarriedState, ABufferWithoutARuleIsRefused) {
  Program program;
  EXPECT_THROW(program.add(row("node_temperature", BufferType::real, 2, Carry::undeclared)), Error);
  EXPECT_EQ(program.add(row("node_temperature", BufferType::real, 2, Carry::copy)), 0);
  Buffer scratch = row("node_flux", BufferType::real, 2, Carry::undeclared);
  scratch.role = BufferRole::scratch;
  EXPECT_EQ(program.add(scratch), 1);
}

// Slots 0 and 1 before; a cut splits the node of slot 1 into slots 2 and 0 and leaves the other in slot 3. Slot 1 has no node.
const std::vector<SlotOrigin> kSplit{{2, 1}, {0, 1}, {3, 0}};

TEST(CarriedState, EveryCopyOfANodeHasItsValue) {
  Buffer heat = row("node_temperature", BufferType::real, 4, Carry::copy);
  heat.padding = 300;
  copy_values(kSplit, {310, 320}, heat);
  EXPECT_EQ(heat.reals, (std::vector<double>{320, 300, 320, 310}));
}

TEST(CarriedState, TheFourthNumberOfATexelIsOfTheNewModel) {
  Buffer u = row("node_u", BufferType::real4, 4, Carry::copy);
  u.reals = {0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 30, 0, 0, 0, 40};
  copy_values(kSplit, {1, 2, 3, 7, 4, 5, 6, 8}, u);
  EXPECT_EQ(u.reals, (std::vector<double>{4, 5, 6, 10, 0, 0, 0, 0, 4, 5, 6, 30, 1, 2, 3, 40}));
}

TEST(CarriedState, OnlyStateOfTheSameSizeIsKept) {
  Program before, next;
  for (const std::size_t count : {1, 2, 3}) before.add(row("b" + std::to_string(count), BufferType::real, count, Carry::drop));
  before.buffers[0].role = BufferRole::constant;
  next.add(row("b3", BufferType::real, 3, Carry::drop));
  next.add(row("b2", BufferType::real, 5, Carry::drop));
  next.add(row("b1", BufferType::real, 1, Carry::drop));
  std::map<BufferId, std::string> kept;
  for_each_kept(before, next, [&](BufferId id, const Buffer& to) { kept[id] = to.name; });
  EXPECT_EQ(kept, (std::map<BufferId, std::string>{{2, "b3"}}));
}

/// A hybrid with tools and contact of tissue: state of nodes, regions, points and pairs.
Scene with_tools() {
  Scene scene = rich_scene();
  scene.bodies[0].model.substeps = 1;
  scene.contact.emplace();
  scene.tools.emplace_back();
  scene.tools[0].name = "ball";
  scene.tools[0].radius = 0.01;
  return scene;
}

TEST(CarriedState, BackupsAreDroppedAndNameToolsAsWhatTheyKeep) {
  const Program program = build_program(build_model(with_tools()), {});
  int copied = 0, moving = 0, tools = 0;
  for (const Buffer& b : program.buffers) {
    copied += b.carry == Carry::copy;
    moving += b.carry == Carry::velocity;
    if (b.role != BufferRole::state) continue;
    tools += b.tools != ToolNumbers::none;
    if (b.copy_of < 0) continue;
    EXPECT_EQ(b.carry, Carry::drop) << b.name;
    EXPECT_EQ(b.tools, program.at(b.copy_of).tools) << b.name;
  }
  EXPECT_EQ(copied, 1);
  EXPECT_EQ(moving, 1);
  EXPECT_EQ(tools, 6);  // contact_near, contact_anchor, contact_start and their backups
}

TEST(CarriedState, AnEditLeavesTheInitialValuesOfItsProgram) {
  const Scene scene = rich_scene();
  const auto run = rich_simulation(scene);
  ASSERT_GT(run->topology_version(), 0);
  for (const Buffer& b : run->program().buffers) {
    if (b.role != BufferRole::state) continue;
    for (std::size_t i = 0; i < b.reals.size(); ++i) {
      if (i % 4 != 3) {
        ASSERT_EQ(b.reals[i], 0) << b.name << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace pliant::carried_state_test
