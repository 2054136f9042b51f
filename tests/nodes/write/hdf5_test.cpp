#include "nodes/write/hdf5.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "nodes/types/audio.h"
#include "nodes/types/face_track.h"
#include "nodes/types/phones.h"
#include "nodes/types/recording.h"
#include "nodes/types/segments.h"
#include "nodes/types/track.h"
#include "tests/source_folder.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

Track example_track() {
  Track track;
  track.values.resize(3, 2);
  track.values << 0.5, -1, 2, NAN, 1.0 / 3, 1e-300;
  track.rate = Rational(30000, 1001);
  track.start = 0.02;
  track.names = {"jaw", "naïve"};
  track.lost = {1};
  return track;
}

LandmarkTrack example_landmarks() {
  Shape points(3, 2);
  points << 1, 2, 3, 4, 5, 6;
  return {{points, 10 * points}, 25, "three"};
}

class WritesHdf5 : public testing::Test {
 protected:
  void SetUp() override { context.folder = folder.path(); }
  template <class T>
  std::string write(const T& value, const std::string& node) {
    const std::string graph = "{\"nodes\": {\"" + node + "\": {}}}";
    return folder.file(WriteHdf5{}(Value::of(value), {node, graph}, context).path);
  }
  template <class T>
  static T read(const std::string& file) {
    T value;
    fields(*hdf5_reader(file), value);
    return value;
  }
  template <class T>
  void expect_round_trip(const T& value, const std::string& node) {
    const T back = read<T>(write(value, node));
    EXPECT_EQ(content_key(Value::of(back)), content_key(Value::of(value))) << node;
  }

  const test::TemporaryFolder folder;
  Context context;
};

TEST_F(WritesHdf5, WhatIsReadBack) {
  expect_round_trip(example_track(), "track");
  expect_round_trip(Track(), "empty track");
  expect_round_trip(Audio{Eigen::Vector3d(0, 0.5, -1), 16000}, "audio");
  expect_round_trip(PhoneTrack{{{"sil", 0, 0.5}, {"", 0.5, 0.75}}}, "phones");
  expect_round_trip(PhoneTrack(), "no phones");
  expect_round_trip(example_landmarks(), "landmarks");
  expect_round_trip(StateData{"a-b", {Eigen::MatrixXd::Ones(2, 3), Eigen::MatrixXd::Zero(4, 3)}, {}}, "ragged");
  expect_round_trip(Table{"t", "c", {"x"}, {"a", "b"}, {{1}, {2}}}, "table");
  expect_round_trip(Scores{{{"acc", 0.5}, {"a/b", 2}}}, "scores");
  FaceTrack face{example_track(), {{1, 0.1, 2, 3}, {}},      {1, 1}, {0, 0}, {3, 4}, {0.5, 0},
                 {0, 1},          example_landmarks().frames};
  expect_round_trip(face, "face");
}

TEST_F(WritesHdf5, RecordingsWithTheirSoundAndPictures) {
  Recording recording;
  recording.id = "u1";
  recording.audio = [] { return Audio{Eigen::Vector2d(0.25, -0.25), 8000}; };
  recording.video = [] { return video_from_frames({cv::Mat(2, 4, CV_8UC3, cv::Scalar(1, 2, 3))}, 25, "memory"); };
  recording.key = [] { return KeyMaker().add("sound and pictures").key(); };
  recording.transcript = Transcript{"hello"};
  const auto back = read<Recording>(write(recording, "recording"));
  EXPECT_EQ(back.audio().samples, Eigen::Vector2d(0.25, -0.25));
  EXPECT_EQ(back.video().read_all().at(0).at<cv::Vec3b>(1, 3), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(back.transcript->text, "hello");
  EXPECT_FALSE(back.phones);
  recording.video = nullptr;
  EXPECT_FALSE(read<Recording>(write(recording, "recording")).video);
}

TEST_F(WritesHdf5, OneFileAnItemOfANode) {
  EXPECT_EQ(WriteHdf5{}(Value::of(Track()), {"in/write", "{}"}, context).path, "hdf5/in/write.h5");
  context.item = "s1/a";
  EXPECT_EQ(WriteHdf5{}(Value::of(Track()), {"in/write", "{}"}, context).path, "hdf5/in/write/s1/a.h5");
  EXPECT_EQ(WriteHdf5{"out"}(Value::of(Track()), {"w", "{}"}, context).path, "out/w/s1/a.h5");
}

TEST_F(WritesHdf5, WholeOrNotAtAll) {
  Video broken{video_from_frames({cv::Mat(2, 2, CV_8UC3)}, 25).source, {}};
  struct Ends final : VideoSource {
    struct Nothing final : Reader {
      bool next(cv::Mat&) override { return false; }
    };
    Rational rate() const override { return 25; }
    std::int64_t frames() const override { return 2; }
    cv::Size size() const override { return {2, 2}; }
    std::unique_ptr<Reader> open() const override { return std::make_unique<Nothing>(); }
    std::string name() const override { return "short.mp4"; }
    Key key() const override { return {}; }
  };
  broken.source = std::make_shared<Ends>();
  try {
    write(broken, "broken");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("short.mp4: ends before its last frame"));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "hdf5")) << "nothing is begun before all is there";
  context.folder = folder.write("in_the_way", "x");
  EXPECT_THROW(write(Track(), "track"), std::runtime_error);
}

/// Reads as a stranger does, with the HDF5 library alone.
class Stranger {
 public:
  explicit Stranger(const std::string& path) : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}
  ~Stranger() { H5Fclose(file_); }
  double number(const char* object, const char* attribute) const {
    const hid_t a = H5Aopen_by_name(file_, object, attribute, H5P_DEFAULT, H5P_DEFAULT);
    double value = NAN;
    H5Aread(a, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(a);
    return value;
  }
  std::string text(const char* object, const char* attribute) const {
    const hid_t a = H5Aopen_by_name(file_, object, attribute, H5P_DEFAULT, H5P_DEFAULT), type = H5Aget_type(a);
    char* raw = nullptr;
    H5Aread(a, type, &raw);
    const std::string value = raw ? raw : "none";
    H5free_memory(raw);
    H5Tclose(type);
    H5Aclose(a);
    return value;
  }
  std::vector<hsize_t> size(const char* dataset) const {
    const hid_t set = H5Dopen2(file_, dataset, H5P_DEFAULT), space = H5Dget_space(set);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return sizes;
  }

 private:
  hid_t file_;
};

TEST_F(WritesHdf5, WhatAStrangerNeeds) {
  context.item = "s1";
  const std::string graph(200'000, ' ');  // longer than 64 kB, as HDF5's own attributes may not be
  const Stranger track(folder.file(WriteHdf5{}(Value::of(example_track()), {"w", graph}, context).path));
  EXPECT_EQ(track.text("/", "type"), "Track");
  EXPECT_EQ(track.number("/", "type_version"), port_type<Track>.version);
  EXPECT_EQ(track.text("/", "item"), "s1");
  EXPECT_EQ(track.text("/", "node"), "w");
  EXPECT_EQ(track.text("/", "provenance"), graph);
  EXPECT_THAT(track.text("/", "made_by"), testing::MatchesRegex("talkgraph [0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(track.number("values", "rate_hz"), 30000.0 / 1001);
  EXPECT_EQ(track.number("values", "start_s"), 0.02);
  EXPECT_EQ(track.number("rate", "number"), 30000.0 / 1001);
  EXPECT_EQ(track.text("rate", "unit"), "Hz");
  EXPECT_EQ(track.size("values"), (std::vector<hsize_t>{3, 2}));
  EXPECT_TRUE(track.size("start").empty());
  const Stranger points(write(example_landmarks(), "points"));
  EXPECT_EQ(points.size("frames"), (std::vector<hsize_t>{2, 3, 2}));
  EXPECT_EQ(points.text("frames", "unit"), "pixel");
  const Stranger phones(write(PhoneTrack{{{"sil", 0, 0.5}, {"aa", 0.5, 1}}}, "phones"));
  EXPECT_EQ(phones.size("phones/label"), std::vector<hsize_t>{2});
  EXPECT_EQ(phones.text("phones/end", "unit"), "s");
}

TEST_F(WritesHdf5, WhatPythonOpens) {
  context.item = "s1";
  write(example_track(), "track");
  write(example_landmarks(), "landmarks");
  write(PhoneTrack{{{"sil", 0, 0.5}, {"aa", 0.5, 0.75}}}, "phones");
  write(Audio{Eigen::Vector3d(0, 0.5, -1), 16000}, "audio");
  write(video_from_frames({cv::Mat(2, 4, CV_8UC3, cv::Scalar(1, 2, 3))}, 25), "video");
  const std::string check = "/usr/bin/python3 " + test::source("/tests/nodes/write/check_hdf5.py");
  const int code = std::system(("cd '" + folder.file("hdf5") + "' && " + check + " > out.txt 2>&1").c_str());
  EXPECT_EQ(code, 0) << folder.read("hdf5/out.txt");
  EXPECT_THAT(folder.read("hdf5/out.txt"), testing::HasSubstr("all is as written"));
}

}  // namespace
}  // namespace talkgraph
