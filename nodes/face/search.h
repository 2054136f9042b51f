#pragma once

#include <vector>

#include "nodes/face/fit.h"

namespace talkgraph {

/// The `count` best places of the mean shape in a picture: windows of sizes
/// from picture_scale / range to picture_scale · range on a grid, by the error
/// of the mean texture; no two are close to each other. Best first.
std::vector<Fit> search_windows(const AppearanceModel& model, Pyramid& pyramid, double range, int count);

}  // namespace talkgraph
