#include "nodes/sync/frames.h"

#include "nodes/sync/video_frames.h"

namespace talkgraph {

Track VideoFrames::operator()(const Audio& audio) const {
  Track frames;
  frames.rate = rate;
  frames.start = video_time(0, rate);
  frames.values.resize(video_frames(audio, rate), 0);
  return frames;
}

void describe(Description<VideoFrames>& d) {
  d.type("sync.frames").summary("the frames of the video rate in a sound, without values");
  d.input("audio", "gives the length").output("frames", "T x 0");
  d.param("rate", &VideoFrames::rate).positive().unit("frames/s").doc("video rate");
}

}  // namespace talkgraph
