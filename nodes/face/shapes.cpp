#include "nodes/face/shapes.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace talkgraph {

void check_dimension(const AppearanceModel& model, const Track& parameters) {
  if (parameters.dimension() != model.modes())
    throw std::runtime_error(fmt::format(
        "the track has {} appearance parameters a frame, the face model has {}: it was made with another model",
        parameters.dimension(), model.modes()));
}

LandmarkTrack FaceShapes::operator()(const AppearanceModel& model, const Track& parameters) const {
  check_dimension(model, parameters);
  LandmarkTrack out{{}, parameters.rate, model.scheme};
  for (Eigen::Index t = 0; t < parameters.frames(); ++t) out.frames.push_back(model.shape(parameters.values.row(t)));
  for (const std::int64_t t : parameters.lost) out.frames[static_cast<std::size_t>(t)].setConstant(NAN);
  return out;
}

void describe(Description<FaceShapes>& d) {
  d.type("face.shapes")
      .version(2)
      .summary("face shapes of appearance parameters, without head pose")
      .source("Thesis Eqn 3.18");
  d.input("model", "of the face")
      .input("parameters", "appearance parameters c")
      .output("shapes", "model frame, pixels of the mean shape");
}

}  // namespace talkgraph
