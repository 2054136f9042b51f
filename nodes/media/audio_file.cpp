#include "nodes/media/audio_file.h"

#include <fmt/format.h>
#include <sndfile.h>
#include <soxr.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nodes/media/ffmpeg.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

struct CloseSound {
  void operator()(SNDFILE* f) const { sf_close(f); }
};
using SoundHandle = std::unique_ptr<SNDFILE, CloseSound>;

struct OpenedSound {
  SoundHandle file;
  SF_INFO info;
  int error;  ///< why there is none
  std::string why;
};

/// One thread after the other: libsndfile tells all of them in one place why it could not open a file.
OpenedSound open_sound(const std::string& path, int mode, SF_INFO info) {
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  SoundHandle file(sf_open(path.c_str(), mode, &info));
  const int error = file ? SF_ERR_NO_ERROR : sf_error(nullptr);
  return {std::move(file), info, error, sf_strerror(nullptr)};
}

/// Bytes of sound that the file lacks of what its header promises, which libsndfile notes in its log:
/// "data : 4000 (should be 2500)". The length of all chunks together matters where that of the data is not noted.
std::uint64_t missing_bytes(SNDFILE* file, int container) {
  constexpr unsigned long long kOpenEnded = 0x7ffff000;  // and above: what programs write that stream
  const bool notes_data = container != SF_FORMAT_RF64 && container != SF_FORMAT_W64;
  std::string log(16384, '\0');
  sf_command(file, SFC_GET_LOG_INFO, log.data(), static_cast<int>(log.size()));
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    char name[10] = "";
    unsigned long long promised = 0, there = 0;
    if (std::sscanf(line.c_str(), " %9[A-Za-z ] : %llu (should be %llu)", name, &promised, &there) != 3) continue;
    const std::string_view what(name);
    const bool counts = notes_data
                            ? what.starts_with("data") || what.starts_with("SSND") || what.starts_with("Data Size")
                            : what.starts_with("riff") || what.starts_with("Riff size");
    if (counts && promised > there && promised < kOpenEnded) return promised - there;
  }
  return 0;
}

bool may_count_frames_wrongly(const SF_INFO& info) { return (info.format & SF_FORMAT_TYPEMASK) == SF_FORMAT_MPEG; }

std::vector<double> mean_of_channels(SNDFILE* file, int channels) {
  std::vector<double> mean;
  std::vector<double> block(static_cast<std::size_t>(channels) * 4096);
  while (const sf_count_t got = sf_readf_double(file, block.data(), 4096)) {
    for (sf_count_t i = 0; i < got; ++i)
      mean.push_back(Eigen::Map<const Eigen::VectorXd>(block.data() + i * channels, channels).mean());
  }
  return mean;
}

Audio read_by_sndfile(SNDFILE* file, const SF_INFO& info, const std::string& path) {
  if (const auto missing = missing_bytes(file, info.format & SF_FORMAT_TYPEMASK))
    throw std::runtime_error(
        fmt::format("{}: breaks off: its header promises {} more bytes of sound than there are", path, missing));
  const auto samples = mean_of_channels(file, info.channels);
  const bool short_of = std::ssize(samples) < info.frames && !may_count_frames_wrongly(info);
  if (sf_error(file) != SF_ERR_NO_ERROR || short_of)
    throw std::runtime_error(fmt::format(
        "{}: breaks off or is damaged after {}{} samples", path, samples.size(),
        info.frames < SF_COUNT_MAX && info.frames > std::ssize(samples) ? fmt::format(" of {}", info.frames) : ""));
  Audio audio;
  audio.samples = Eigen::Map<const Eigen::VectorXd>(samples.data(), std::ssize(samples));
  audio.rate = info.samplerate;
  return audio;
}

void check(const Audio& audio, const std::string& path) {
  if (audio.samples.size() == 0) throw std::runtime_error(path + ": holds not one sample of sound");
  if (!(audio.rate >= 1000 && audio.rate <= 1e6))
    throw std::runtime_error(
        fmt::format("{}: its header gives a rate of {} samples per second, which no speech has", path, audio.rate));
  for (Eigen::Index i = 0; i < audio.samples.size(); ++i)
    if (!std::isfinite(audio.samples[i]))
      throw std::runtime_error(fmt::format("{}: sample {} (at {:.3f} s) is not a finite number", path, i,
                                           static_cast<double>(i) / audio.rate));
}

int sndfile_format(WavFormat format) {
  switch (format) {
    case WavFormat::pcm16:
      return SF_FORMAT_WAV | SF_FORMAT_PCM_16;
    case WavFormat::pcm24:
      return SF_FORMAT_WAV | SF_FORMAT_PCM_24;
    case WavFormat::float32:
      return SF_FORMAT_WAV | SF_FORMAT_FLOAT;
  }
  throw std::invalid_argument("unknown WAV format");
}

}  // namespace

Audio read_audio(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error(path + ": there is no such file");
  if (!fs::is_regular_file(path)) throw std::runtime_error(path + ": is not a file");
  if (fs::file_size(path) == 0) throw std::runtime_error(path + ": is empty");
  const auto [file, info, error, why] = open_sound(path, SFM_READ, {});
  Audio audio;
  if (file)
    audio = read_by_sndfile(file.get(), info, path);
  else if (error == SF_ERR_UNRECOGNISED_FORMAT)
    audio = ffmpeg_audio(path);
  else
    throw std::runtime_error(fmt::format("{}: cannot be read as sound: {}", path, why));
  check(audio, path);
  return audio;
}

void write_audio(const std::string& path, const Audio& audio, WavFormat format) {
  if (audio.rate != std::round(audio.rate) || audio.rate < 1 || audio.rate > 1e6)
    throw std::invalid_argument(
        fmt::format("{}: a WAV file cannot hold {} samples per second; resample to a whole rate", path, audio.rate));
  if (!audio.samples.allFinite()) throw std::invalid_argument(path + ": the sound to write is not finite");
  SF_INFO wanted{};
  wanted.samplerate = static_cast<int>(audio.rate);
  wanted.channels = 1;
  wanted.format = sndfile_format(format);
  const auto [file, info, error, why] = open_sound(path, SFM_WRITE, wanted);
  if (!file) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, why));
  sf_command(file.get(), SFC_SET_CLIPPING, nullptr, SF_TRUE);
  sf_command(file.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);  // it holds the time of day
  const auto written = sf_write_double(file.get(), audio.samples.data(), audio.samples.size());
  sf_write_sync(file.get());
  if (written != audio.samples.size() || sf_error(file.get()) != SF_ERR_NO_ERROR)
    throw std::runtime_error(path + ": cannot be written whole: is there room on the disk?");
}

Audio resampled(const Audio& audio, double rate) {
  if (rate == audio.rate || audio.samples.size() == 0) return {audio.samples, rate};
  const auto wanted = std::llround(static_cast<double>(audio.samples.size()) * rate / audio.rate);
  Audio out{Eigen::VectorXd::Zero(wanted), rate};
  const auto io = soxr_io_spec(SOXR_FLOAT64_I, SOXR_FLOAT64_I);
  const auto quality = soxr_quality_spec(SOXR_HQ, 0);
  const auto runtime = soxr_runtime_spec(1);
  std::size_t used = 0, made = 0;
  const soxr_error_t error =
      soxr_oneshot(audio.rate, rate, 1, audio.samples.data(), static_cast<std::size_t>(audio.samples.size()), &used,
                   out.samples.data(), static_cast<std::size_t>(wanted), &made, &io, &quality, &runtime);
  if (error) throw std::runtime_error(fmt::format("resampling {} Hz to {} Hz: {}", audio.rate, rate, error));
  return out;
}

}  // namespace talkgraph
