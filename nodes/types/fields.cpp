#include <stdexcept>

#include "nodes/types/audio.h"
#include "nodes/types/face_track.h"
#include "nodes/types/phones.h"
#include "nodes/types/recording.h"
#include "nodes/types/report.h"
#include "nodes/types/segments.h"
#include "nodes/types/shape.h"
#include "nodes/types/track.h"

namespace talkgraph {

void fields(Archive& ar, Audio& a) {
  ar("samples", a.samples);
  ar("rate", a.rate);
}

void fields(Archive& ar, Track& t) {
  ar("values", t.values);
  ar("rate", t.rate);
  ar("start", t.start);
  ar("names", t.names);
  ar("lost", t.lost);
}

void fields(Archive& ar, Mask& m) { ar("frames", m.frames); }

void fields(Archive& ar, Interval& i) {
  ar("label", i.label);
  ar("start", i.start);
  ar("end", i.end);
}

void fields(Archive& ar, PhoneTrack& p) { ar("phones", p.phones); }
void fields(Archive& ar, WordTrack& w) { ar("words", w.words); }
void fields(Archive& ar, Transcript& t) { ar("text", t.text); }

void fields(Archive& ar, FrameLabels& l) {
  ar("labels", l.labels);
  ar("rate", l.rate);
}

void fields(Archive& ar, LandmarkTrack& l) {
  std::vector<Eigen::MatrixXd> frames(l.frames.begin(), l.frames.end());
  ar("frames", frames);
  if (ar.loading()) l.frames.assign(frames.begin(), frames.end());
  ar("rate", l.rate);
  ar("scheme", l.scheme);
}

void fields(Archive& ar, Recording& r) {
  if (!ar.hashing()) throw std::logic_error("recording " + r.id + ": a recording is a handle; store its parts instead");
  ar("id", r.id);
  ar("split", r.split);
  if (r.key) {
    Key key = r.key();
    ar("key", key);
  } else {
    Audio audio = r.audio();
    ar("audio", audio);
    std::optional<Video> video;
    if (r.video) video = r.video();
    ar("video", video);
  }
  ar("visual", r.visual);
  ar("transcript", r.transcript);
  ar("words", r.words);
  ar("phones", r.phones);
  ar("landmarks", r.landmarks);
}

void fields(Archive& ar, Pose& p) {
  ar("scale", p.scale);
  ar("angle", p.angle);
  ar("dx", p.dx);
  ar("dy", p.dy);
}

void fields(Archive& ar, FaceTrack& f) {
  ar("parameters", f.parameters);
  ar("poses", f.poses);
  ar("gain", f.gain);
  ar("offset", f.offset);
  ar("residual", f.residual);
  ar("lost", f.lost);
  std::vector<Eigen::MatrixXd> shapes(f.shapes.begin(), f.shapes.end());
  ar("shapes", shapes);
  if (ar.loading()) f.shapes.assign(shapes.begin(), shapes.end());
}

void fields(Archive& ar, Segment& s) {
  ar("label", s.label);
  ar("start", s.start);
  ar("length", s.length);
}

void fields(Archive& ar, SegmentTrack& s) {
  ar("segments", s.segments);
  ar("frames", s.frames);
  ar("rate", s.rate);
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
  ar("cells", t.cells);
}

void fields(Archive& ar, Scores& s) { ar("values", s.values); }

void fields(Archive& ar, Plot& p) {
  ar("title", p.title);
  ar("svg", p.svg);
}

void fields(Archive& ar, Artifact& a) {
  ar("path", a.path);
  ar("title", a.title);
}

}  // namespace talkgraph
