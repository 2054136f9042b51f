#include "nodes/types/picture_file.h"

#include <stdexcept>

#include "graph/output_file.h"
#include "nodes/codecs/codecs.h"
#include "nodes/types/codec.h"

namespace talkgraph {

cv::Mat read_picture(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error(file.string() + ": there is no such file");
  cv::Mat pixels;
  codec<decltype(codec_read_picture)>("codec_read_picture")(file.string(), pixels);
  if (pixels.empty()) throw std::runtime_error(file.string() + ": cannot be decoded as a picture");
  return pixels;
}

void write_picture(const std::filesystem::path& file, const cv::Mat& pixels) {
  OutputFile whole(file);
  if (pixels.empty() || !codec<decltype(codec_write_picture)>("codec_write_picture")(whole.part(), pixels))
    throw std::runtime_error(file.string() +
                             ": the picture cannot be written; is there room, and may one write there?");
  whole.finish();
}

}  // namespace talkgraph
