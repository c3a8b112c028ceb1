// How often this executable has called operator new.
#pragma once

namespace pliant::haptics_test {

long allocations();

}  // namespace pliant::haptics_test
