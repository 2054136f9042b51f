#include <sndfile.h>

#include <limits>
#include <random>

#include "nodes/media/audio_file.h"
#include "tests/nodes/media/media_test.h"
#include "tests/nodes/speech/chains.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

/// A format of libsndfile, how many channels it takes, and how far samples and MFCCs may be from
/// those of a 16-bit recording.
struct Encoding {
  const char* name;
  int format;
  int channels = 8;
  double samples = 0;
  double features = 1e-9;
};

constexpr double kLossy = INFINITY;
constexpr int kWav = SF_FORMAT_WAV, kAiff = SF_FORMAT_AIFF, kAu = SF_FORMAT_AU, kFlac = SF_FORMAT_FLAC;
constexpr int k8 = SF_FORMAT_PCM_U8, k16 = SF_FORMAT_PCM_16, k24 = SF_FORMAT_PCM_24, k32 = SF_FORMAT_PCM_32,
              kFloat = SF_FORMAT_FLOAT, kDouble = SF_FORMAT_DOUBLE;

const std::vector<Encoding> kEncodings = {
    {"wav-8", kWav | k8, 8, 0.01, 0.05},
    {"wav-16", kWav | k16},
    {"wav-24", kWav | k24},
    {"wav-32", kWav | k32},
    {"wav-float", kWav | kFloat},
    {"wav-double", kWav | kDouble},
    {"wav-ulaw", kWav | SF_FORMAT_ULAW, 8, 0.02, 0.05},
    {"wav-alaw", kWav | SF_FORMAT_ALAW, 8, 0.02, 0.05},
    {"wav-ima", kWav | SF_FORMAT_IMA_ADPCM, 2, kLossy, 0.5},
    {"rifx-16", kWav | k16 | SF_ENDIAN_BIG},
    {"extensible-8", SF_FORMAT_WAVEX | k8, 8, 0.01, 0.05},
    {"extensible-16", SF_FORMAT_WAVEX | k16},
    {"extensible-24", SF_FORMAT_WAVEX | k24},
    {"extensible-32", SF_FORMAT_WAVEX | k32},
    {"extensible-float", SF_FORMAT_WAVEX | kFloat},
    {"extensible-double", SF_FORMAT_WAVEX | kDouble},
    {"rf64-16", SF_FORMAT_RF64 | k16},
    {"rf64-24", SF_FORMAT_RF64 | k24},
    {"w64-16", SF_FORMAT_W64 | k16},
    {"w64-double", SF_FORMAT_W64 | kDouble},
    {"aiff-16", kAiff | k16},
    {"aiff-24", kAiff | k24},
    {"aiff-float", kAiff | kFloat},
    {"au-16", kAu | k16},
    {"au-double", kAu | kDouble},
    {"caf-16", SF_FORMAT_CAF | k16},
    {"flac-16", kFlac | k16},
    {"flac-24", kFlac | k24},
    {"ogg-vorbis", SF_FORMAT_OGG | SF_FORMAT_VORBIS, 8, kLossy, 0.5},
    {"ogg-opus", SF_FORMAT_OGG | SF_FORMAT_OPUS, 2, kLossy, 0.5},
    {"mp3", SF_FORMAT_MPEG | SF_FORMAT_MPEG_LAYER_III, 2, kLossy, 0.5},
};

/// A buzz with noise, as 16 bits hold it.
Audio buzz(double seconds, double rate = 16000) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.03);
  Audio audio{Eigen::VectorXd(std::lround(seconds * rate)), rate};
  for (Eigen::Index i = 0; i < audio.samples.size(); ++i) {
    double sum = 0;
    for (int k = 1; k <= 20; ++k) sum += 0.3 / k * std::sin(2 * M_PI * 150 * k * static_cast<double>(i) / rate);
    audio.samples[i] = std::round(32768 * std::clamp(sum + noise(random), -0.9, 0.9)) / 32768;
  }
  return audio;
}

Eigen::MatrixXd mfcc(const Audio& audio) { return test::mfcc(audio).values; }

class HardAudio : public MediaTest {
 protected:
  /// A file of a sound, the same in all channels.
  std::string encode(const Audio& sound, const Encoding& encoding, int channels = 1) const {
    SF_INFO info{};
    info.samplerate = static_cast<int>(sound.rate);
    info.channels = channels;
    info.format = encoding.format;
    const std::string file = path(encoding.name);
    SNDFILE* out = sf_open(file.c_str(), SFM_WRITE, &info);
    EXPECT_TRUE(out) << encoding.name << ": " << sf_strerror(nullptr);
    if (!out) return file;
    std::vector<double> samples;
    for (const double x : sound.samples) samples.insert(samples.end(), static_cast<std::size_t>(channels), x);
    const int kind = encoding.format & SF_FORMAT_SUBMASK;
    if (kind == k16 || kind == k24 || kind == k32) {  // sf_write_double would scale by one step less than full scale
      std::vector<int> numbers;
      for (const double x : samples) numbers.push_back(static_cast<int>(std::min(std::ldexp(x, 31), 0x1.fffep30)));
      sf_write_int(out, numbers.data(), std::ssize(numbers));
    } else {
      sf_write_double(out, samples.data(), std::ssize(samples));
    }
    sf_close(out);
    return file;
  }

  /// What reading a file gives that may be damaged: finite sound of a sensible size, or an error that names it.
  std::string outcome(const std::string& file) const {
    try {
      const Audio audio = read_audio(file);
      EXPECT_TRUE(audio.samples.allFinite());
      EXPECT_GT(audio.samples.size(), 0);
      EXPECT_LT(audio.samples.size(), 1'000'000);
      EXPECT_GE(audio.rate, 1000);
      return "sound";
    } catch (const std::runtime_error& e) {
      EXPECT_THAT(e.what(), HasSubstr(file));
      return e.what();
    }
  }

  /// A new file each time: file systems write one that is written over to the disk at once, which takes long.
  std::string fresh(const std::string& name, const std::string& content) const {
    std::filesystem::remove(path(name));
    return write(name, content);
  }

  /// A 16-bit WAV file of 320 samples with some bytes of its header replaced.
  std::string lie(std::size_t at, const std::string& value) const {
    write_audio(path("lie.wav"), tone(0.02, 16000));
    return write("lie.wav", bytes(path("lie.wav")).replace(at, value.size(), value));
  }
};

std::string word(std::uint16_t x) { return {static_cast<char>(x & 0xff), static_cast<char>(x >> 8)}; }
std::string dword(std::uint32_t x) {
  return word(static_cast<std::uint16_t>(x & 0xffff)) + word(static_cast<std::uint16_t>(x >> 16));
}

TEST_F(HardAudio, EncodingsOfOneSoundGiveTheSameSamplesAndFeatures) {
  const Audio sound = buzz(0.5);
  const Eigen::MatrixXd features = mfcc(sound);
  for (const auto& encoding : kEncodings)
    for (const int channels : {1, 2, 3, 4, 5, 6, 7, 8}) {
      if (channels > encoding.channels) break;
      SCOPED_TRACE(std::string(encoding.name) + ", channels: " + std::to_string(channels));
      Audio back = read_audio(encode(sound, encoding, channels));
      EXPECT_EQ(back.rate, sound.rate);
      if (encoding.samples == kLossy) {  // these fill their last block
        ASSERT_GE(back.samples.size(), sound.samples.size());
        back.samples.conservativeResize(sound.samples.size());
      }
      ASSERT_EQ(back.samples.size(), sound.samples.size());
      // The mean of three equal numbers may differ from each in the last bit.
      EXPECT_LE((back.samples - sound.samples).cwiseAbs().maxCoeff(), encoding.samples + 2e-16);
      const Eigen::MatrixXd error = (mfcc(back) - features).cwiseAbs();
      EXPECT_LE(error.mean(), encoding.features);
    }
}

TEST_F(HardAudio, EveryRate) {
  for (const double rate : {8000., 11025., 16000., 22050., 32000., 44100., 48000., 88200., 96000., 176400., 192000.})
    for (const auto& encoding : kEncodings) {
      if (encoding.samples > 0) continue;
      const Audio sound = tone(0.01, rate);
      const Audio back = read_audio(encode(sound, encoding));
      EXPECT_EQ(back.rate, rate) << encoding.name;
      EXPECT_EQ(back.samples.size(), sound.samples.size()) << encoding.name;
    }
}

TEST_F(HardAudio, SilenceDirectCurrentClippingAndSingleSamplesStayAsTheyAre) {
  const Eigen::VectorXd square = (tone(0.05, 16000).samples.array() > 0).select(Eigen::VectorXd::Ones(800), -1);
  for (const auto& encoding : kEncodings) {
    if (encoding.samples > 0) continue;
    for (const Eigen::VectorXd& samples :
         {Eigen::VectorXd(Eigen::VectorXd::Zero(800)), Eigen::VectorXd(Eigen::VectorXd::Constant(800, 0.25)), square,
          Eigen::VectorXd(Eigen::VectorXd::Constant(1, -0.5))}) {
      const Audio back = read_audio(encode({samples, 16000}, encoding));
      ASSERT_EQ(back.samples.size(), samples.size()) << encoding.name;
      EXPECT_LE((back.samples - samples).cwiseAbs().maxCoeff(), 1.0 / 32768) << encoding.name;  // +1 is clipped
    }
  }
}

TEST_F(HardAudio, WhatIsNotANumberIsRefusedInEveryFloatFormat) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (const auto& encoding : kEncodings) {
      const int kind = encoding.format & SF_FORMAT_SUBMASK;
      if (kind != kFloat && kind != kDouble) continue;
      Audio sound = tone(0.01, 16000);
      sound.samples[7] = bad;
      EXPECT_THAT(outcome(encode(sound, encoding, 2)), HasSubstr("sample 7 ")) << encoding.name;
    }
}

TEST_F(HardAudio, LyingHeaders) {
  const auto samples = [&](const std::string& file) { return read_audio(file).samples.size(); };
  EXPECT_THAT(outcome(lie(40, dword(4000))), HasSubstr("3360 more bytes of sound than there are"));
  EXPECT_EQ(samples(lie(40, dword(100))), 50);
  EXPECT_EQ(samples(lie(40, dword(0xffffffff))), 320);
  EXPECT_EQ(samples(lie(40, dword(0x7ffff000))), 320);
  EXPECT_THAT(outcome(lie(40, dword(0))), HasSubstr("not one sample"));
  EXPECT_EQ(samples(lie(4, dword(0xffffffff))), 320) << "the length of the whole does not matter";
  EXPECT_EQ(samples(lie(4, dword(10))), 320);
  EXPECT_EQ(samples(lie(28, dword(1))), 320) << "nor do bytes per second";
  for (const std::uint32_t rate : {0u, 1u, 0x7fffffffu, 0xffffffffu})
    EXPECT_THAT(outcome(lie(24, dword(rate))), testing::HasSubstr("lie.wav: ")) << rate;
  for (const std::uint16_t align : {0, 1, 3, 65535}) EXPECT_EQ(samples(lie(32, word(align))), 320) << align;
  EXPECT_THAT(outcome(lie(22, word(0))), HasSubstr("Channel count is zero"));
  EXPECT_THAT(outcome(lie(22, word(1000))), HasSubstr("not one sample"));
  EXPECT_THAT(outcome(lie(22, word(65535))), HasSubstr("Too many channels"));
  for (const std::uint16_t bits : {0, 33, 65535})
    EXPECT_THAT(outcome(lie(34, word(bits))), HasSubstr("cannot be read as sound")) << bits;
  for (const std::uint16_t tag : {0, 2, 3, 0x55, 0x1234, 0xfffe})
    EXPECT_THAT(outcome(lie(20, word(tag))), HasSubstr("cannot be read as sound")) << tag;
}

TEST_F(HardAudio, TruncatedFilesAreRefusedWhereTheyHaveALength) {
  for (const auto& encoding : kEncodings) {
    const std::string whole = bytes(encode(tone(0.02, 16000), encoding));
    int sounds = 0;
    for (std::size_t length = 1; length < whole.size(); length += 1 + whole.size() / 800)
      sounds += outcome(fresh("cut", whole.substr(0, length))) == "sound";
    const std::string name = encoding.name;
    // MP3 says no length; in CAF the last four samples are not missed.
    EXPECT_LE(sounds, name == "mp3" ? 800 : name == "caf-16" ? 2 : 0) << name;
  }
}

TEST_F(HardAudio, RandomDamageEndsInSoundOrAnError) {
  std::mt19937 random(1);
  for (const auto& encoding : kEncodings) {
    const std::string whole = bytes(encode(tone(0.02, 16000), encoding));
    for (int trial = 0; trial < 150; ++trial) {
      std::string damaged = whole;
      const std::size_t reach = trial % 2 ? std::min<std::size_t>(80, whole.size()) : whole.size();
      for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
        damaged[random() % reach] = static_cast<char>(random());
      outcome(fresh("damaged", damaged));
    }
  }
}

}  // namespace
}  // namespace talkgraph
