#include "nodes/write/landmarks.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/types/item_file.h"
#include "nodes/types/picture_file.h"

namespace talkgraph {
namespace {

/// The n-th file of a folder: names sort as numbers do.
std::filesystem::path numbered(const std::filesystem::path& folder, std::size_t n, const char* ending) {
  return folder / fmt::format("{:06}{}", n, ending);
}

void write_pts(const std::filesystem::path& file, const Shape& shape) {
  try {
    write_file(file, pts_text(shape));
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

}  // namespace

std::string pts_text(const Shape& shape) {
  std::string text = fmt::format("version: 1\nn_points: {}\n{{\n", shape.rows());
  for (Eigen::Index p = 0; p < shape.rows(); ++p) {
    if (!shape.row(p).allFinite())
      throw std::invalid_argument(fmt::format("point {} is missing, which this format cannot say", p));
    text += fmt::format("{} {}\n", shape(p, 0) + 1, shape(p, 1) + 1);
  }
  return text + "}\n";
}

Artifact WriteLandmarks::operator()(const LandmarkTrack& landmarks, Context& context) const {
  const auto& frames = landmarks.frames;
  const auto has_landmarks = [](const Shape& shape) { return !shape.array().isNaN().all(); };
  if (std::none_of(frames.begin(), frames.end(), has_landmarks))
    throw std::invalid_argument("the clip has no frame to write landmarks of");
  Artifact artifact = item_file(context, folder, "", "landmarks");
  for (std::size_t t = 0; t < frames.size(); ++t)
    if (has_landmarks(frames[t])) write_pts(numbered(context.file(artifact.path), t, ".pts"), frames[t]);
  return artifact;
}

void describe(Description<WriteLandmarks>& d) {
  d.type("write.landmarks").summary("writes landmarks as .pts files, one a frame that has some").sink();
  d.input("landmarks", "of every frame").output("file", "the folder of a clip");
  d.param("folder", &WriteLandmarks::folder).doc("below the run folder");
}

Artifact WritePrototypes::operator()(const Prototypes& prototypes, Context& context) const {
  for (std::size_t i = 0; i < prototypes.images.size(); ++i) {
    write_picture(numbered(context.file(folder), i, ".png"), prototypes.images[i].pixels);
    write_pts(numbered(context.file(folder), i, ".pts"), prototypes.shapes.at(i));
  }
  return {folder, "prototypes"};
}

void describe(Description<WritePrototypes>& d) {
  d.type("write.prototypes").summary("writes pictures as .png with their landmarks as .pts beside them").sink();
  d.input("prototypes", "pictures and shapes").output("file", "the folder");
  d.param("folder", &WritePrototypes::folder).doc("below the run folder");
}

}  // namespace talkgraph
