// What speech parameters cost: processor time of one core over ten minutes of sound of 16 kHz.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "bench/child.h"
#include "bench/rows.h"
#include "tests/nodes/speech/chains.h"
#include "tests/nodes/speech/written_out.h"

namespace talkgraph::bench {

constexpr double seconds = 600;

/// The DFTs of all frames and nothing else, in blocks that stay in the cache.
void transforms_alone() {
  cv::Mat frames = cv::Mat::ones(64, 512, CV_64F), bins;
  for (int done = 0; done < 100 * seconds; done += frames.rows) cv::dft(frames, bins, cv::DFT_ROWS);
}

/// Samples as SPTK reads them: floats at the scale of 16 bits.
void write_floats(const std::filesystem::path& file, const Audio& audio) {
  const Eigen::VectorXf samples = (32768 * audio.samples).cast<float>();
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(samples.data()),
            static_cast<std::streamsize>(sizeof(float)) * samples.size());
}

void compare() {
  const Audio audio = test::voice(seconds);
  std::vector<Row> rows = {
      {"MFCC", own([&] { test::mfcc(audio); })},
      {"PLP", own([&] { test::plp(audio); })},
      {"PLP of Bark bands", own([&] { test::plp_bark(audio); })},
      {"RASTA-PLP", own([&] { test::rasta_plp(audio); })},
      {"LPC", own([&] { test::lpc(audio); })},
      {"LPC and LSF", own([&] { test::lsf(audio); })},
      {"DFTs alone, `cv::dft`", own(transforms_alone)},
  };
  const auto file = std::filesystem::temp_directory_path() / fmt::format("talkgraph-bench-{}.raw", getpid());
  write_floats(file, audio);
  const std::string frames = fmt::format("sptk frame -n -l 400 -p 160 {}", file.string());
  std::string missing;
  for (const auto& [name, command] : {
           std::pair<std::string, std::string>{"SPTK, MFCC", frames + " | sptk mfcc -l 400 -L 512 -m 20 -n 30 -c 1"},
           {"SPTK, LPC and LSF", frames + " | sptk window -l 400 -w 1 | sptk lpc -l 400 -m 20 | sptk lpc2lsp -m 20"},
       }) {
    const auto peer = [command] { return child_cpu_time({"bash", "-o", "pipefail", "-c", command}); };
    try {
      peer();
      rows.push_back({name, peer});
    } catch (const std::runtime_error& e) {
      missing += fmt::format("\n{} was not measured: {}\n", name, e.what());
    }
  }
  measure(rows);
  std::filesystem::remove(file);
  fmt::print("Processor time for {} s of sound of 16 kHz, median of {} (least to most):\n\n", seconds, rounds);
  fmt::print("| parameters | seconds | times real time |\n|---|---|---|\n");
  for (const auto& row : rows)
    fmt::print("| {} | {:.3f} ({:.3f} to {:.3f}) | {:.0f} |\n", row.name, row.median(), row.seen.front(),
               row.seen.back(), seconds / row.median());
  fmt::print("{}", missing);
}

}  // namespace talkgraph::bench

int main() {
  try {
    talkgraph::bench::compare();
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_speech: {}\n", e.what());
    return 1;
  }
}
