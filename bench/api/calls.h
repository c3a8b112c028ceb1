// How long a renderer waits in its calls while it cuts.
#pragma once
#include <string>

namespace pliant::bench_api {

/// A renderer's loop at 60 frames a second: it moves a blade through the body, asks for the next steps and takes the newest
/// frame. Prints the median, the 99th percentile and the worst time of each call, and how many frames had no new state to show.
int measure_calls(const std::string& scene, const std::string& backend, int frames);

}  // namespace pliant::bench_api
