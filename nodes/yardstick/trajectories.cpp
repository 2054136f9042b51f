#include "nodes/yardstick/trajectories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nodes/types/vlmm.h"

namespace talkgraph {

namespace {

/// Rows at `length` even distances, by linear interpolation.
Eigen::MatrixXd stretched(const Eigen::MatrixXd& rows, Eigen::Index length) {
  Eigen::MatrixXd out(length, rows.cols());
  const double step = static_cast<double>(rows.rows()) / static_cast<double>(length);
  for (Eigen::Index t = 0; t < length; ++t) {
    const double at =
        std::clamp((static_cast<double>(t) + 0.5) * step - 0.5, 0.0, static_cast<double>(rows.rows() - 1));
    const auto before = static_cast<Eigen::Index>(at), after = std::min(before + 1, rows.rows() - 1);
    const double share = at - static_cast<double>(before);
    out.row(t) = (1 - share) * rows.row(before) + share * rows.row(after);
  }
  return out;
}

}  // namespace

TrajectoriesModel TrajectoriesTrain::operator()(const Collected<StateData>& states) const {
  TrajectoriesModel model;
  std::map<std::string, Eigen::Index> most;
  Eigen::Index all = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const StateData& state = states[i];
    Eigen::Index frames = 0;
    for (const Eigen::MatrixXd& window : state.visual) {
      if (model.mean.size() == 0) model.mean.setZero(window.cols());
      if (window.cols() != model.mean.size() || !window.allFinite())
        throw std::runtime_error(
            fmt::format("state \"{}\" has a window of {} dimensions, others {}, or values that are "
                        "not finite",
                        state.label, window.cols(), model.mean.size()));
      frames += window.rows();
      model.mean += window.colwise().sum();
    }
    if (frames == 0) continue;
    all += frames;
    const auto windows = static_cast<double>(state.visual.size());
    const auto length = static_cast<Eigen::Index>(std::lround(static_cast<double>(frames) / windows));
    Eigen::MatrixXd& trajectory = model.trajectories[state.label];
    trajectory.setZero(length, model.mean.size());
    for (const Eigen::MatrixXd& window : state.visual) trajectory += stretched(window, length) / windows;
    if (auto& largest = most[last_phone(state.label)]; frames > largest) {
      largest = frames;
      model.ending[last_phone(state.label)] = state.label;
    }
  }
  if (all == 0) throw std::runtime_error("mean trajectories of no windows: is the training selection empty?");
  model.mean /= static_cast<double>(all);
  return model;
}

Track TrajectoriesPredict::operator()(const TrajectoriesModel& model, const SegmentTrack& segments) const {
  Track out;
  out.rate = segments.rate;
  out.start = 0.5 / segments.rate.value();
  out.values.resize(segments.frames, model.mean.size());
  Eigen::Index at = 0;
  for (const Segment& s : segments.segments) {
    if (s.start != at || s.length < 1 || s.start + s.length > segments.frames)
      throw std::runtime_error(
          fmt::format("segment \"{}\" at frame {} does not follow frame {}", s.label, s.start, at));
    const Eigen::MatrixXd* trajectory = value_for_label(s.label, model.trajectories, model.ending);
    out.values.middleRows(s.start, s.length) =
        trajectory ? stretched(*trajectory, s.length) : Eigen::MatrixXd(model.mean.replicate(s.length, 1));
    at += s.length;
  }
  if (at != segments.frames)
    throw std::runtime_error(fmt::format("segments end at frame {} of {}", at, segments.frames));
  return out;
}

void describe(Description<TrajectoriesTrain>& d) {
  d.type("yardstick.trajectories_train").version(1).summary("the mean visual trajectory of every state").stored();
  d.input("states", "the training windows of each").output("model", "a trajectory a state");
}

void describe(Description<TrajectoriesPredict>& d) {
  d.type("yardstick.trajectories").version(1).summary("the mean training trajectory of each segment's state");
  d.input("model", "of yardstick.trajectories_train")
      .input("segments", "of new speech")
      .output("track", "visual parameters");
}

}  // namespace talkgraph
