// Writes the small study of the tests with clips that play: write_small_study FOLDER

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "nodes/speaker/renderer.h"
#include "nodes/types/audio.h"
#include "nodes/write/clip.h"
#include "tests/study/small_study.h"

namespace talkgraph::study {
namespace {

constexpr int rate = 25, frames = 20, size = 300, sound_rate = 16000;

/// A mouth that opens and closes as the clip's number has it.
Video speaking(const face::Renderer& renderer, int number, bool lower_half) {
  std::vector<cv::Mat> pictures;
  for (int n = 0; n < frames; ++n) {
    face::Moment moment{};
    moment.mouth.jaw = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * n * (1 + number % 3) / frames);
    moment.mouth.width = number % 2 ? 0.5 : -0.3;
    const auto picture = renderer.draw(moment, 1000 * number + n);
    const int left = (picture.cols - size) / 2;
    auto square = picture(cv::Rect(left, 0, size, size)).clone();
    if (lower_half) square.rowRange(0, size / 2).setTo(cv::Scalar::all(128));
    pictures.push_back(square);
  }
  return video_from_frames(std::move(pictures), rate);
}

Audio humming(int number) {
  Audio sound;
  sound.rate = sound_rate;
  sound.samples.resize(sound_rate * frames / rate);
  for (Eigen::Index i = 0; i < sound.samples.size(); ++i)
    sound.samples(i) = 0.1 * std::sin(2 * std::numbers::pi * (100 + 10 * number) * static_cast<double>(i) / sound_rate);
  return sound;
}

void write(const std::filesystem::path& folder) {
  write_study(small_study(), folder);
  const face::Renderer renderer(size, 1);
  Context context;
  context.folder = folder;
  for (const auto& test : small_study().tests)
    for (int number = 0; const auto& clip : test.clips) {
      context.item = clip.id;
      const auto video = speaking(renderer, number, test.kind == TestKind::turing);
      const auto sound = humming(number++);
      for (const auto format : {ClipFormat::webm, ClipFormat::mp4}) {
        WriteClip node;
        node.format = format;
        node.crf = 34;
        node(video, test.kind == TestKind::intelligibility ? nullptr : &sound, context);
      }
    }
}

}  // namespace
}  // namespace talkgraph::study

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  talkgraph::study::write(argv[1]);
}
