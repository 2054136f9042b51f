#include "nodes/corpus/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nodes/evaluate/lag.h"
#include "nodes/evaluate/lips.h"
#include "nodes/media/check_video.h"
#include "nodes/phones/pronunciation.h"
#include "nodes/phones/words.h"
#include "nodes/types/scheme.h"
#include "nodes/types/visemes.h"

namespace talkgraph {
namespace {

bool is_whole(const Shape& shape) { return shape.rows() > 0 && shape.allFinite(); }

/// Whether the middles of the inner lips are known in every frame.
bool shows_lips(const LandmarkTrack& landmarks) {
  const auto& frames = landmarks.frames;
  if (frames.empty() || !std::all_of(frames.begin(), frames.end(), is_whole)) return false;
  const auto scheme = find_scheme(landmarks.scheme);
  return scheme && scheme->names.contains("inner_top") && scheme->names.contains("inner_bottom");
}

void inspect_landmarks(const LandmarkTrack& landmarks, Scores& out) {
  double gaps = 0;
  for (const auto& shape : landmarks.frames) gaps += !is_whole(shape);
  out.values["landmark_frames"] = static_cast<double>(landmarks.frames.size());
  out.values["landmark_gaps"] = gaps;
}

/// Where the mouth will be: the lower half of the box around all landmarks, else the middle of the picture's lower
/// half.
cv::Rect lower_face(const LandmarkTrack* landmarks, cv::Size size) {
  Eigen::RowVector2d low(INFINITY, INFINITY), high(-INFINITY, -INFINITY);
  if (landmarks)
    for (const auto& shape : landmarks->frames)
      if (is_whole(shape)) {
        low = low.cwiseMin(shape.colwise().minCoeff());
        high = high.cwiseMax(shape.colwise().maxCoeff());
      }
  const cv::Rect picture({}, size);
  if (low.x() < high.x()) {
    const double middle = 0.5 * (low.y() + high.y());
    const cv::Rect box(cv::Point(static_cast<int>(low.x()), static_cast<int>(middle)),
                       cv::Point(static_cast<int>(high.x()) + 1, static_cast<int>(high.y()) + 1));
    if (!(box & picture).empty()) return box & picture;
  }
  return {size.width / 4, size.height / 2, std::max(1, size.width / 2), std::max(1, size.height / 2)};
}

struct Seen {
  Eigen::VectorXd motion;  ///< mean change of grey level since the frame before; the first frame has the second's
  cv::Scalar colour;       ///< mean of all frames
};

/// Reads the lower face through.
Seen look_at(const Video& video, const LandmarkTrack* landmarks, const Context& context) {
  constexpr int width = 64;
  const cv::Rect region = lower_face(landmarks, video.source->size());
  std::vector<double> change;
  cv::Scalar sum;
  double count = 0;
  const auto reader = video.source->open();
  cv::Mat frame, grey, now, before;
  for (; reader->next(frame); ++count) {
    context.check_cancelled();
    sum += cv::mean(frame(region));
    cv::cvtColor(frame(region), grey, cv::COLOR_BGR2GRAY);
    cv::resize(grey, now, {width, std::max(1, region.height * width / region.width)}, 0, 0, cv::INTER_AREA);
    if (!before.empty()) change.push_back(cv::norm(now, before, cv::NORM_L1) / static_cast<double>(now.total()));
    now.copyTo(before);
  }
  if (!change.empty()) change.insert(change.begin(), change.front());
  return {Eigen::Map<const Eigen::VectorXd>(change.data(), std::ssize(change)), sum / std::max(1.0, count)};
}

/// Change since the frame before; of the first, none.
Eigen::VectorXd change(const Eigen::VectorXd& values) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(values.size());
  for (Eigen::Index t = 1; t < out.size(); ++t) out(t) = values(t) - values(t - 1);
  return out;
}

/// Motion goes with the envelope. Where the lips are known, so does the change of the gap between them with the
/// envelope's change, and motion with the size of that: half as telling each, but sharper in time.
Eigen::VectorXd lags(const Audio& audio, const Eigen::VectorXd& moved, Rational fps, const LandmarkTrack* landmarks,
                     int max_lag) {
  const Eigen::VectorXd envelope = sound_envelope(audio, fps, moved.size());
  const Eigen::VectorXd by_motion = lag_correlations(moved, envelope, max_lag);
  if (!landmarks || !shows_lips(*landmarks)) return by_motion;
  const Eigen::VectorXd gap = point_distance(*landmarks, "inner_top", "inner_bottom"), rise = change(envelope);
  return 0.5 * by_motion + 0.25 * lag_correlations(change(gap), rise, max_lag) +
         0.25 * lag_correlations(moved, rise.cwiseAbs(), max_lag);
}

void inspect_video(const Recording& recording, const Audio& audio, int max_lag, Context& context, Scores& out) {
  const Video video = CheckVideo{}(recording.video(), context);
  const auto& source = *video.source;
  out.values["fps"] = source.rate().value();
  out.values["frames"] = static_cast<double>(source.frames());
  out.values["width"] = source.size().width;
  out.values["height"] = source.size().height;
  out.values["picture_seconds"] = static_cast<double>(source.frames()) / source.rate().value();
  out.values["damaged"] = static_cast<double>(video.damaged.size());
  if (!video.damaged.empty()) {
    out.values["damaged_from"] = static_cast<double>(video.damaged.front());
    out.values["damaged_to"] = static_cast<double>(video.damaged.back());
  }
  const LandmarkTrack* landmarks = recording.landmarks ? &*recording.landmarks : nullptr;
  const auto seen = look_at(video, landmarks, context);
  out.values["blue"] = seen.colour[0];
  out.values["green"] = seen.colour[1];
  out.values["red"] = seen.colour[2];
  const auto found = lags(audio, seen.motion, source.rate(), landmarks, max_lag);
  for (int lag = -max_lag; lag <= max_lag; ++lag)
    if (const double r = found(lag + max_lag); !std::isnan(r)) out.values[fmt::format("lag {}", lag)] = r;
}

Scores count_phones(const Recording& recording) {
  Scores out;
  if (recording.phones) {
    for (const auto& p : recording.phones->phones) out.values[p.label] += 1;
  } else if (recording.transcript) {
    for (const auto& phone : phones_of_words(spoken_words(recording.transcript->text))) out.values[phone] += 1;
  }
  std::erase_if(out.values, [](const auto& entry) { return is_pause(entry.first); });
  return out;
}

}  // namespace

Inspect::Out Inspect::operator()(const Recording& recording, Context& context) const {
  Out out;
  auto& found = out.findings.values;
  const Audio audio = recording.audio();
  found["sound_rate"] = audio.rate;
  found["sound_seconds"] = audio.seconds();
  found["sound_peak"] = audio.samples.size() > 0 ? audio.samples.cwiseAbs().maxCoeff() : 0;
  found["transcript"] = recording.transcript.has_value();
  found["words"] = recording.words.has_value();
  found["phones"] = recording.phones.has_value();
  found["landmarks"] = recording.landmarks.has_value();
  found["visual"] = recording.visual.has_value();
  if (recording.landmarks) inspect_landmarks(*recording.landmarks, out.findings);
  if (recording.video) inspect_video(recording, audio, max_lag, context, out.findings);
  out.phones = count_phones(recording);
  return out;
}

void describe(Description<Inspect>& d) {
  d.type("corpus.inspect")
      .version(2)
      .summary("looks a recording over: rates, lengths, damage, sound against picture, phones")
      .source("docs/manifest.md")
      .stored();
  d.input("recording", "one utterance")
      .output("findings", &Inspect::Out::findings, "numbers by name; which there are says what the recording has")
      .output("phones", &Inspect::Out::phones, "how often each phone occurs");
  d.param("max_lag", &Inspect::max_lag).within(1, 100).unit("frames").doc("longest shift of the picture that is tried");
}

}  // namespace talkgraph
