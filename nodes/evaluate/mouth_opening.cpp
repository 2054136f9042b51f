#include "nodes/evaluate/mouth_opening.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "nodes/evaluate/lips.h"
#include "nodes/evaluate/mean.h"
#include "nodes/types/paired.h"

namespace talkgraph {
namespace {

/// Those that are there.
Eigen::VectorXd finite(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> there;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values(i))) there.push_back(i);
  return values(there);
}

}  // namespace

std::optional<Scores> MouthOpening::operator()(const LandmarkTrack& landmarks, const FrameLabels& labels) const {
  const auto frames = common_frames("the sequence", std::ssize(landmarks.frames), "frames with landmarks",
                                    std::ssize(labels.labels), "labels");
  if (frames == 0) return {};
  const Eigen::VectorXd widths = finite(point_distance(landmarks, left, right));
  if (widths.size() == 0) return {};
  const double width = widths.mean();
  if (!(width > 0)) throw std::runtime_error("the corners of the mouth are one point in every frame");
  const Eigen::VectorXd gap = point_distance(landmarks, upper, lower) / width;
  const auto among = [](const std::vector<std::string>& phones, const std::string& phone) {
    return std::find(phones.begin(), phones.end(), phone) != phones.end();
  };
  Mean closed_gap, open_gap, pause_gap;
  for (Eigen::Index from = 0, to = 0; from < frames; from = to) {
    const auto& phone = labels.labels[static_cast<std::size_t>(from)];
    while (to < frames && labels.labels[static_cast<std::size_t>(to)] == phone) ++to;
    const Eigen::VectorXd run = finite(gap.segment(from, to - from));
    if (run.size() == 0) continue;
    if (among(closed, phone)) closed_gap.add(run.minCoeff());
    if (among(open, phone)) open_gap.add(run.maxCoeff());
    if (phone == "sil") pause_gap.add(run.mean(), static_cast<double>(run.size()));
  }
  Scores scores;
  closed_gap.store(scores, "closed");
  open_gap.store(scores, "open");
  pause_gap.store(scores, "pause");
  if (scores.values.empty()) return {};
  return scores;
}

void describe(Description<MouthOpening>& d) {
  d.type("evaluate.mouth_opening")
      .version(2)
      .summary("how far the lips part on closed phones, open phones and in pauses");
  d.input("landmarks", "of the face, recorded or synthesised")
      .input("labels", "phone of every frame")
      .output("scores",
              "closed: least gap between the lips in phones that close them, widths of the mouth; open: largest gap "
              "between the lips in open vowels, widths of the mouth; pause: mean gap between the lips in pauses, "
              "widths of the mouth");
  d.param("closed", &MouthOpening::closed).doc("phones on which the lips meet");
  d.param("open", &MouthOpening::open).doc("phones on which the mouth opens");
  d.param("upper", &MouthOpening::upper)
      .doc("point in the middle of the inner upper lip, by its name in the point scheme");
  d.param("lower", &MouthOpening::lower).doc("point in the middle of the inner lower lip");
  d.param("left", &MouthOpening::left).doc("corner of the mouth");
  d.param("right", &MouthOpening::right).doc("the other corner");
}

}  // namespace talkgraph
