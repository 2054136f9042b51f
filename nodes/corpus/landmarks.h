#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "nodes/types/shape.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Where the landmarks of a clip are.
struct LandmarkFiles {
  std::string path;    ///< .csv, .h5 or .hdf5, or a folder of .pts or .asf files
  std::string scheme;  ///< name of a built-in one, or the text of a scheme file; empty: "ibug68" for 68 points
  std::string dataset = "frames";  ///< of HDF5
  bool sparse = false;             ///< of some frames, which the names of the files or the column "frame" tell
};

/// "000012.pts" and "12.pts" -> 12; nothing for a file that is not named after a frame.
std::optional<std::int64_t> frame_in_name(const std::filesystem::path& file);

/// The points of one picture in the format of the iBUG annotations; 1-based pixels become 0-based. Throws
/// std::runtime_error that names the file and the line: not there, malformed, another number of points than it
/// promises.
Shape read_pts(const std::string& path);

/// The points of one picture of `size` in the format of the IMM data base, which has them as shares of the picture's
/// width and height. Errors as of read_pts.
Shape read_asf(const std::string& path, cv::Size size);

/// Landmarks of a clip, pixels from 0. A CSV has the columns x0,y0,x1,y1,... and maybe "frame" before them, in any
/// order if it names them; HDF5 a data set of frames × points × 2 or frames × 2 points; a frame without landmarks is
/// nan in both. A folder has a file a frame, whose names end in consecutive numbers from 0, or from anything if the
/// clip has as many frames. Sparse ones count frames from 0: files are named 000012.pts, other files are passed over;
/// the frames between have points that are nan. `video` is asked for the length of the clip (sparse) and the size of
/// its pictures (.asf). Throws std::runtime_error that names the file, and the line where there are lines.
LandmarkTrack read_landmarks(const LandmarkFiles& files, Rational rate, const std::function<Video()>& video = {});

}  // namespace talkgraph
