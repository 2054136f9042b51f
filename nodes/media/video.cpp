#include "nodes/media/video.h"

#include <filesystem>

#include "nodes/media/video_file.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {

Video OpenVideo::operator()() const {
  if (std::filesystem::is_directory(file.path)) return open_frame_folder(file.path, rate);
  if (!is_picture_name(file.path)) return open_video(file.path);
  return video_from_frames({read_picture(file.path)}, rate, file.path);
}

void describe(Description<OpenVideo>& d) {
  d.type("media.video").summary("opens a video file, a still picture or a folder of pictures");
  d.output("video", "opened when its frames are asked for");
  d.param("file", &OpenVideo::file).required().doc("video, PNG or JPEG picture, or folder of pictures");
  d.param("rate", &OpenVideo::rate).positive().unit("frames/s").doc("of a picture or a folder; a video says its own");
}

}  // namespace talkgraph
