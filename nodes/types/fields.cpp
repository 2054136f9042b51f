#include <functional>
#include <memory>

#include "nodes/types/audio.h"
#include "nodes/types/face_track.h"
#include "nodes/types/hmm.h"
#include "nodes/types/lds.h"
#include "nodes/types/phones.h"
#include "nodes/types/recording.h"
#include "nodes/types/report.h"
#include "nodes/types/segments.h"
#include "nodes/types/shape.h"
#include "nodes/types/stored_model.h"
#include "nodes/types/track.h"

namespace talkgraph {
namespace {

/// Says on a member with one entry a frame when its frames are.
void note_frames(Archive& ar, std::string_view member, Rational rate, double start) {
  ar.note(member, "rate_hz", rate.value());
  ar.note(member, "start_s", start);
}

void check(const Hmm& h) {
  const StoredModel stored("hidden Markov model");
  const Eigen::Index k = h.states();
  stored.matrix("start", h.start, k, 1);
  stored.weights("start", h.start);
  stored.matrix("transitions", h.transitions, k, k);
  stored.weights("transitions", h.transitions);
  stored.require(std::ssize(h.observations) == k, "observations", "are not one a state");
  for (const auto& mixture : h.observations) stored.mixture("observations", mixture, h.observations[0].dimension());
}

void check(const Lds& l) {
  const StoredModel stored("linear dynamical system");
  const Eigen::Index d = l.states();
  stored.require(d > 0, "prediction", "is empty");
  stored.matrix("first_mean", l.first_mean, d, 1);
  stored.matrix("first_covariance", l.first_covariance, d, d);
  stored.matrix("prediction", l.prediction, d, d);
  stored.matrix("offset", l.offset, d, 1);
  stored.matrix("prediction_noise", l.prediction_noise, d, d);
  stored.matrix("mean", l.mean, 1, l.dimension());
  stored.matrix("observation", l.observation, l.dimension(), d);
  stored.covariance("observation_noise", l.observation_noise, l.dimension());
}

/// Loaded sound and pictures, as a recording gives them.
template <class T>
std::function<T()> giving(T value) {
  return [held = std::make_shared<const T>(std::move(value))] { return *held; };
}

}  // namespace

void fields(Archive& ar, Audio& a) {
  ar("samples", a.samples);
  ar("rate", a.rate, "Hz");
  ar.note("samples", "rate_hz", a.rate);
}

void fields(Archive& ar, Track& t) {
  ar("values", t.values);
  ar("rate", t.rate, "Hz");
  ar("start", t.start, "s");
  note_frames(ar, "values", t.rate, t.start);
  ar("names", t.names);
  ar("lost", t.lost);
}

void fields(Archive& ar, Mask& m) { ar("frames", m.frames); }

void fields(Archive& ar, Interval& i) {
  ar("label", i.label);
  ar("start", i.start, "s");
  ar("end", i.end, "s");
}

void fields(Archive& ar, PhoneTrack& p) { ar("phones", p.phones); }
void fields(Archive& ar, WordTrack& w) { ar("words", w.words); }
void fields(Archive& ar, Transcript& t) { ar("text", t.text); }

void fields(Archive& ar, FrameLabels& l) {
  ar("labels", l.labels);
  ar("rate", l.rate, "Hz");
  note_frames(ar, "labels", l.rate, 0);
}

void fields(Archive& ar, LandmarkTrack& l) {
  ar("frames", l.frames, "pixel");
  ar("rate", l.rate, "Hz");
  note_frames(ar, "frames", l.rate, 0);
  ar("scheme", l.scheme);
}

void fields(Archive& ar, Recording& r) {
  ar("id", r.id);
  ar("split", r.split);
  if (ar.hashing() && r.key) {
    Key key = r.key();
    ar("key", key);
  } else {
    Audio audio = r.audio ? r.audio() : Audio();
    ar("audio", audio);
    std::optional<Video> video;
    if (r.video) video = r.video();
    ar("video", video);
    if (ar.loading()) {
      r.audio = giving(std::move(audio));
      r.video = video ? giving(std::move(*video)) : nullptr;
      r.key = nullptr;
    }
  }
  ar("visual", r.visual);
  ar("transcript", r.transcript);
  ar("words", r.words);
  ar("phones", r.phones);
  ar("landmarks", r.landmarks);
}

void fields(Archive& ar, Pose& p) {
  ar("scale", p.scale);
  ar("angle", p.angle, "rad");
  ar("dx", p.dx, "pixel");
  ar("dy", p.dy, "pixel");
}

void fields(Archive& ar, FaceTrack& f) {
  ar("parameters", f.parameters);
  ar("poses", f.poses);
  ar("gain", f.gain);
  ar("offset", f.offset);
  ar("residual", f.residual, "grey level");
  ar("confidence", f.confidence);
  ar("lost", f.lost);
  ar("shapes", f.shapes, "pixel");
  note_frames(ar, "shapes", f.parameters.rate, f.parameters.start);
}

void fields(Archive& ar, Segment& s) {
  ar("label", s.label);
  ar("start", s.start, "frame");
  ar("length", s.length, "frame");
}

void fields(Archive& ar, SegmentTrack& s) {
  ar("segments", s.segments);
  ar("frames", s.frames);
  ar("rate", s.rate, "Hz");
}

void fields(Archive& ar, GaussianMixture& m) {
  ar("weights", m.weights);
  ar("means", m.means);
  ar("covariances", m.covariances);
}

void fields(Archive& ar, Gmm& g) {
  ar("mixture", g.mixture);
  ar("trace", g.trace);
  if (ar.loading()) StoredModel("Gaussian mixture").mixture("mixture", g.mixture, g.mixture.dimension());
}

void fields(Archive& ar, Hmm& h) {
  ar("start", h.start);
  ar("transitions", h.transitions);
  ar("observations", h.observations);
  ar("trace", h.trace);
  if (ar.loading()) check(h);
}

void fields(Archive& ar, Lds& l) {
  ar("first_mean", l.first_mean);
  ar("first_covariance", l.first_covariance);
  ar("prediction", l.prediction);
  ar("offset", l.offset);
  ar("prediction_noise", l.prediction_noise);
  ar("mean", l.mean);
  ar("observation", l.observation);
  ar("observation_noise", l.observation_noise);
  ar("trace", l.trace);
  if (ar.loading()) check(l);
}

void fields(Archive& ar, StateData& s) {
  ar("label", s.label);
  ar("audio", s.audio);
  ar("visual", s.visual);
}

void fields(Archive& ar, Table& t) {
  ar("title", t.title);
  ar("corner", t.corner);
  ar("columns", t.columns);
  ar("rows", t.rows);
  Eigen::MatrixXd cells;
  if (!ar.loading()) cells.resize(std::ssize(t.rows), std::ssize(t.columns));
  for (Eigen::Index r = 0; r < cells.rows(); ++r)
    for (Eigen::Index c = 0; c < cells.cols(); ++c)
      cells(r, c) = t.cells.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
  ar("cells", cells);
  if (!ar.loading()) return;
  t.cells.clear();
  for (const auto row : cells.rowwise()) t.cells.emplace_back(row.begin(), row.end());
}

void fields(Archive& ar, Scores& s) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const auto& [name, value] : s.values) {
    names.push_back(name);
    values.push_back(value);
  }
  ar("names", names);
  ar("values", values);
  if (!ar.loading()) return;
  s.values.clear();
  for (std::size_t i = 0; i < names.size(); ++i) s.values[names[i]] = values.at(i);
}

void fields(Archive& ar, Plot& p) {
  ar("title", p.title);
  ar("svg", p.svg);
}

void fields(Archive& ar, Artifact& a) {
  ar("path", a.path);
  ar("title", a.title);
}

}  // namespace talkgraph
