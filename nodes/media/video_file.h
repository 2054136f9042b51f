#pragma once

#include <string>

#include "nodes/types/video.h"

namespace talkgraph {

/// A video file, by FFmpeg. Opening reads the header; the number of frames is
/// counted by decoding the file once, when it is first asked for. Pictures are
/// turned upright as the file says. A file of changing frame rate is read at its
/// average rate, pictures repeated or left out so that they stay in time with the
/// sound. Throws std::runtime_error naming the file: missing, not a video; when
/// frames are counted or read: broken off.
Video open_video(const std::string& path);

/// The PNG and JPEG files of a folder in the order of their names, numbers in
/// them by value (frame2 before frame10). Throws std::runtime_error: no such
/// folder, no pictures in it; when read: a picture that cannot be decoded or is
/// of another size than the first.
Video open_frame_folder(const std::string& folder, Rational rate);

/// True for names that end in .png, .jpg or .jpeg, in either case.
bool is_picture_name(const std::string& name);

/// Compares names so that numbers in them go by value.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace talkgraph
