#include "nodes/media/audio_file.h"

#include <sndfile.h>

#include <atomic>
#include <limits>
#include <thread>

#include "nodes/media/ffmpeg.h"
#include "nodes/media/resample.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using AudioFileTest = MediaTest;

/// Interleaved samples in any format of libsndfile.
void write_samples(const std::string& path, const std::vector<double>& samples, int channels, int format) {
  SF_INFO info{};
  info.samplerate = 16000;
  info.channels = channels;
  info.format = format;
  SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
  ASSERT_TRUE(file);
  sf_write_double(file, samples.data(), std::ssize(samples));
  sf_close(file);
}

TEST_F(AudioFileTest, EveryEncodingGivesTheSameSound) {
  const Audio sound = tone(0.1, 16000);
  const std::vector<double> samples(sound.samples.begin(), sound.samples.end());
  const std::vector<std::pair<int, double>> formats = {
      {SF_FORMAT_WAV | SF_FORMAT_PCM_U8, 1.1 / 128},    {SF_FORMAT_WAV | SF_FORMAT_PCM_16, 1.1 / 32768},
      {SF_FORMAT_WAV | SF_FORMAT_PCM_24, 1e-6},         {SF_FORMAT_WAV | SF_FORMAT_PCM_32, 1e-8},
      {SF_FORMAT_WAV | SF_FORMAT_FLOAT, 1e-7},          {SF_FORMAT_WAV | SF_FORMAT_DOUBLE, 0},
      {SF_FORMAT_AIFF | SF_FORMAT_PCM_16, 1.1 / 32768}, {SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 1.1 / 32768},
      {SF_FORMAT_OGG | SF_FORMAT_VORBIS, 0.05}};
  for (const auto& [format, tolerance] : formats) {
    write_samples(path("sound"), samples, 1, format);
    const Audio back = read_audio(path("sound"));
    EXPECT_EQ(back.rate, 16000);
    ASSERT_EQ(back.samples.size(), sound.samples.size()) << std::hex << format;
    EXPECT_LE((back.samples - sound.samples).cwiseAbs().maxCoeff(), tolerance) << std::hex << format;
  }
}

TEST_F(AudioFileTest, ChannelsBecomeTheirMean) {
  write_samples(path("stereo.wav"), {0.5, 0.25, -0.5, 0.5, 1, 0}, 2, SF_FORMAT_WAV | SF_FORMAT_DOUBLE);
  const Audio sound = read_audio(path("stereo.wav"));
  ASSERT_EQ(sound.samples.size(), 3);
  EXPECT_TRUE(sound.samples.isApprox(Eigen::Vector3d(0.375, 0, 0.5)));
}

TEST_F(AudioFileTest, SamplesThatAreNotNumbersAreRefused) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    write_samples(path("bad.wav"), {0, 0, bad, 0}, 1, SF_FORMAT_WAV | SF_FORMAT_FLOAT);
    EXPECT_THAT(error_of([&] { read_audio(path("bad.wav")); }), AllOf(HasSubstr("bad.wav"), HasSubstr("sample 2")));
  }
}

TEST_F(AudioFileTest, MissingEmptyAndForeignFiles) {
  EXPECT_THAT(error_of([&] { read_audio(path("no.wav")); }), HasSubstr("no.wav: there is no such file"));
  EXPECT_THAT(error_of([&] { read_audio(folder_.string()); }), HasSubstr("is not a file"));
  EXPECT_THAT(error_of([&] { read_audio(write("empty.wav", "")); }), HasSubstr("empty.wav: is empty"));
  EXPECT_THAT(error_of([&] { read_audio(write("text.wav", std::string(3000, 'x'))); }), HasSubstr("text.wav: "));
  write_samples(path("nothing.wav"), {}, 1, SF_FORMAT_WAV | SF_FORMAT_PCM_16);
  EXPECT_THAT(error_of([&] { read_audio(path("nothing.wav")); }), HasSubstr("not one sample"));
}

// libsndfile tells all threads in one place why it could not open a file.
TEST_F(AudioFileTest, ThreadsDoNotMixUpWhyAFileCannotBeOpened) {
  const std::string foreign = write("foreign.wav", std::string(5000, 'x')), sound = path("sound.wav");
  write_samples(sound, {0.5, 0.25}, 1, SF_FORMAT_WAV | SF_FORMAT_DOUBLE);
  const auto why = [&] { return error_of([&] { read_audio(foreign); }); };
  const std::string alone = why();
  std::atomic<bool> enough = false;
  std::jthread other([&] {
    while (!enough) read_audio(sound);
  });
  for (int i = 0; i < 500; ++i) EXPECT_EQ(why(), alone) << i;
  enough = true;
}

TEST_F(AudioFileTest, TruncatedFilesAreRefused) {
  const Audio sound = tone(1, 16000);
  const std::vector<double> samples(sound.samples.begin(), sound.samples.end());
  for (const int format :
       {SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_WAV | SF_FORMAT_FLOAT, SF_FORMAT_FLAC | SF_FORMAT_PCM_16}) {
    write_samples(path("whole"), samples, 1, format);
    const std::string whole = bytes(path("whole"));
    write("part", whole.substr(0, whole.size() / 2));
    EXPECT_THAT(error_of([&] { read_audio(path("part")); }), HasSubstr("breaks off")) << std::hex << format;
    write("head", whole.substr(0, 20));
    EXPECT_THAT(error_of([&] { read_audio(path("head")); }), HasSubstr("head: ")) << std::hex << format;
  }
}

TEST_F(AudioFileTest, AnOpenEndedHeaderIsReadToTheEndOfTheFile) {
  write_audio(path("whole.wav"), tone(0.5, 16000));
  std::string open = bytes(path("whole.wav"));
  const auto data = open.find("data");
  open.replace(4, 4, 4, '\xff');
  open.replace(data + 4, 4, 4, '\xff');
  EXPECT_EQ(read_audio(write("open.wav", open)).samples.size(), 8000);
}

TEST_F(AudioFileTest, WritingClipsAndRefusesWhatDoesNotFit) {
  Audio loud{Eigen::Vector3d(2, -2, 0.5), 8000};
  for (const auto format : {WavFormat::pcm16, WavFormat::pcm24}) {
    write_audio(path("loud.wav"), loud, format);
    EXPECT_TRUE(read_audio(path("loud.wav")).samples.isApprox(Eigen::Vector3d(1, -1, 0.5), 1e-4));
  }
  write_audio(path("loud.wav"), loud, WavFormat::float32);
  EXPECT_EQ(read_audio(path("loud.wav")).samples, loud.samples);
  loud.rate = 8000.5;
  EXPECT_THROW(write_audio(path("x.wav"), loud), std::invalid_argument);
  loud.rate = 8000;
  EXPECT_THAT(error_of([&] { write_audio(path("no/x.wav"), loud); }), HasSubstr("cannot be written"));
  loud.samples[0] = NAN;
  EXPECT_THROW(write_audio(path("x.wav"), loud), std::invalid_argument);
}

TEST(Resample, KeepsTonesInPlaceAndRemovesAliases) {
  for (const double from : {8000., 11025., 22050., 32000., 44100., 48000., 88200., 96000., 192000.}) {
    const Audio out = Resample{16000}(tone(1, from, 1000));
    ASSERT_EQ(out.samples.size(), 16000);
    EXPECT_EQ(out.rate, 16000);
    const Eigen::VectorXd error = out.samples - tone(1, 16000, 1000).samples;
    EXPECT_LT(error.segment(1000, 14000).cwiseAbs().maxCoeff(), 1e-4) << from;
  }
  for (const double from : {22050., 44100., 48000., 96000., 192000.})
    for (const double hertz : {9000., 10500.}) {
      const Audio above = Resample{16000}(tone(1, from, hertz));
      EXPECT_LT(above.samples.segment(1000, 14000).cwiseAbs().maxCoeff(), 1e-5) << hertz << " Hz at " << from << " Hz";
    }
}

TEST(Resample, Degenerate) {
  const Audio same = tone(0.1, 16000);
  EXPECT_EQ(Resample{16000}(same).samples, same.samples);
  EXPECT_EQ(Resample{16000}(Audio{{}, 44100}).samples.size(), 0);
  EXPECT_EQ(Resample{16000}(Audio{{}, 44100}).rate, 16000);
  EXPECT_EQ(Resample{16000}(Audio{Eigen::VectorXd::Ones(1), 8000}).samples.size(), 2);
  EXPECT_TRUE(Resample{16000}(Audio{Eigen::VectorXd::Zero(1000), 8000}).samples.isZero());
}

}  // namespace
}  // namespace talkgraph
