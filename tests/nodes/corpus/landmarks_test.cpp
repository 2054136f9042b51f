#include "nodes/corpus/landmarks.h"

#include "graph/archive.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

class LandmarksTest : public MediaTest {
 protected:
  LandmarkTrack read(const std::string& file, bool sparse = false) {
    return read_landmarks({.path = file, .scheme = "", .sparse = sparse}, 25, [this] {
      return test_video(length, 25, {100, 50});
    });
  }
  std::string error(const std::string& file, bool sparse = false) {
    return error_of([&] { read(file, sparse); });
  }

  int length = 4;  ///< frames of the clip
};

Shape shape(double x0, double y0, double x1, double y1) { return (Shape(2, 2) << x0, y0, x1, y1).finished(); }

TEST_F(LandmarksTest, Csv) {
  const auto track = read(write("a.csv", "frame,x0,y0,x1,y1\n0,1,2,3,4\n1,5,6,7,8\n"));
  ASSERT_EQ(track.frames.size(), 2u);
  EXPECT_EQ(track.frames[1], shape(5, 6, 7, 8));
  EXPECT_EQ(track.rate, Rational(25));
  EXPECT_EQ(track.scheme, "");
  EXPECT_EQ(read(write("b.csv", "1,2,3,4\n")).frames[0], shape(1, 2, 3, 4));
  std::string row = "0";
  for (int i = 1; i < 136; ++i) row += "," + std::to_string(i);
  EXPECT_EQ(read(write("c.csv", row + "\n")).scheme, "ibug68");
}

TEST_F(LandmarksTest, ColumnsOfACsvAreFoundByTheirNames) {
  const auto track = read(write("a.csv", "x0,x1,y0, Y1 ,frame\n1,3,2,4,0\n5,7,6,8,1\n"));
  EXPECT_EQ(track.frames[0], shape(1, 2, 3, 4));
  EXPECT_EQ(track.frames[1], shape(5, 6, 7, 8));
  const auto error_with = [&](const std::string& head) { return error(write("b.csv", head + "\n0,1,2,3\n")); };
  EXPECT_THAT(error_with("x0,y0,x2,y2"),
              HasSubstr("b.csv: landmarks need the columns x0,y0,x1,y1,... and maybe \"frame\" before them; it has no "
                        "\"x1\", but \"x2\""));
  EXPECT_THAT(error_with("x1,y1,x2,y2"), HasSubstr("no \"x0\", but \"x1\""));
  EXPECT_THAT(error_with("frame,confidence,x0,y0"), HasSubstr("no \"x1\", but \"confidence\""));
  EXPECT_THAT(error_with("frame,x0,x1,y0"), HasSubstr("no \"y1\""));
  EXPECT_THAT(error_with("x0,y0,x0,y1"), HasSubstr("has two columns \"x0\""));
}

TEST_F(LandmarksTest, AFrameOfACsvMayHaveNone) {
  const auto track = read(write("a.csv", "nan,NaN,nan,nan\n1,2,3,4\n"));
  ASSERT_EQ(track.frames.size(), 2u) << "a row of nan is no header";
  EXPECT_TRUE(track.frames[0].array().isNaN().all());
  EXPECT_EQ(track.frames[1], shape(1, 2, 3, 4));
  EXPECT_THAT(error(write("b.csv", "frame,x0,y0\nnan,1,2\n")), HasSubstr("b.csv:2: frame 0 is expected, got nan"));
}

TEST_F(LandmarksTest, MalformedCsv) {
  EXPECT_THAT(error(write("a.csv", "frame,x0,y0\n0,1,2\n\n2,1,2\n")), HasSubstr("a.csv:4: frame 1 is expected, got 2"));
  EXPECT_THAT(error(write("b.csv", "1,2,3\n")), HasSubstr("b.csv: landmarks need the columns"));
  EXPECT_THAT(error(write("c.csv", "1,2\n1,inf\n")), HasSubstr("c.csv:2: a number is expected"));
  EXPECT_THAT(error(write("d.csv", "1,2\n1\n")), HasSubstr("d.csv:2: 2 columns are expected"));
  EXPECT_THAT(error(path("none.csv")), HasSubstr("none.csv: is missing"));
}

TEST_F(LandmarksTest, SomeFramesOfACsv) {
  const auto track = read(write("a.csv", "frame,x0,y0,x1,y1\n2,1,2,3,4\n0,5,6,7,8\n"), true);
  ASSERT_EQ(track.frames.size(), 4u) << "as the video has";
  EXPECT_EQ(track.frames[2], shape(1, 2, 3, 4));
  EXPECT_EQ(track.frames[0], shape(5, 6, 7, 8));
  for (const std::size_t t : {1u, 3u}) EXPECT_TRUE(track.frames[t].array().isNaN().all());
  EXPECT_EQ(track.frames[3].rows(), 2);
  EXPECT_THAT(error(write("b.csv", "1,2\n"), true), HasSubstr("b.csv: landmarks of some frames need a first column"));
  EXPECT_THAT(error(write("c.csv", "frame,x0,y0\n1,1,2\n1,1,2\n"), true),
              HasSubstr("c.csv:3: frame 1 stands here again"));
  EXPECT_THAT(error(write("d.csv", "frame,x0,y0\n-1,1,2\n"), true), HasSubstr("d.csv:2: -1 is no number of a frame"));
  EXPECT_THAT(error(write("e.csv", "frame,x0,y0\n4,1,2\n"), true),
              HasSubstr("landmarks of frame 4; the clip has the frames 0 to 3"));
}

TEST_F(LandmarksTest, PtsFolder) {
  write("p/f9.pts", "version: 1\nn_points: 2\n{\n1 2\n3.5 4\n}\n");
  write("p/f10.pts", "version: 1\r\nn_points:  2\r\n\f\r\n\r\r\n{\r\n5 6\r\n7 8\r\n}\r\n");
  length = 2;
  const auto track = read(path("p"));
  ASSERT_EQ(track.frames.size(), 2u);
  EXPECT_EQ(track.frames[0], shape(0, 1, 2.5, 3)) << "1-based pixels become 0-based";
  EXPECT_EQ(track.frames[1], shape(4, 5, 6, 7));
  write("p/f11.pts", "{\n5 6\n}\n");
  length = 3;
  EXPECT_THAT(error(path("p")), HasSubstr("f11.pts: holds 1 points, the first file of the folder 2"));
  write("p/g.asf", "1\n");
  EXPECT_THAT(error(path("p")), HasSubstr("holds .pts and .asf files"));
}

TEST_F(LandmarksTest, AFolderLacksNoFrame) {
  const auto fill = [&](const std::string& folder, std::vector<int> numbers) {
    for (const int n : numbers) write(fmt::format("{}/s1_{:03}.pts", folder, n), fmt::format("{{\n{} 1\n}}\n", n + 1));
    return path(folder);
  };
  for (const auto& [name, first] : std::map<std::string, int>{{"zero", 0}, {"one", 1}, {"cut", 95}}) {
    const auto track = read(fill(name, {first, first + 1, first + 2, first + 3}));
    EXPECT_EQ(track.frames[3](0, 0), first + 3) << name;
  }
  EXPECT_THAT(error(fill("gap", {0, 1, 3})),
              AllOf(HasSubstr("gap: there is no file of frame 2; if only some frames"), HasSubstr("\"sparse\": true")));
  EXPECT_THAT(error(fill("gaps", {0, 3, 5})), HasSubstr("gaps: there is no file of the frames 1, 2, 4;"));
  EXPECT_THAT(error(fill("many", {0, 99})), HasSubstr("8, 9, 10, ...; if"));
  EXPECT_THAT(error(fill("late", {1, 2, 3})),
              HasSubstr("late: has files of the frames 1 to 3, and the clip 4 frames: which is the first?"));
  EXPECT_THAT(error_of([&] { read_landmarks({.path = fill("cut", {}), .scheme = ""}, 25); }),
              HasSubstr("cut: has files of the frames 95 to 98: which is the first?"));
  EXPECT_EQ(read_landmarks({.path = fill("one", {}), .scheme = ""}, 25).frames.size(), 4u);
  write("names/a.pts", "{\n1 1\n}\n");
  EXPECT_THAT(error(path("names")), HasSubstr("a.pts: its name does not end in the number of its frame"));
  write("two/s1_000.pts", "{\n1 1\n}\n");
  write("two/s1_001.pts", "{\n1 1\n}\n");
  write("two/s2_000.pts", "{\n1 1\n}\n");
  EXPECT_THAT(error(path("two")), HasSubstr("s2_000.pts: frame 2 is expected after \"s1_001.pts\""));
}

TEST_F(LandmarksTest, SomeFramesOfAFolder) {
  write("p/000003.pts", "{\n1 2\n3 4\n}\n");
  write("p/000001.pts", "{\n5 6\n7 8\n}\n");
  write("p/000001.part-7-1.pts", "{\n");
  const auto track = read(path("p"), true);
  ASSERT_EQ(track.frames.size(), 4u);
  EXPECT_EQ(track.frames[3], shape(0, 1, 2, 3));
  EXPECT_EQ(track.frames[1], shape(4, 5, 6, 7));
  EXPECT_TRUE(track.frames[0].hasNaN());
  write("p/1.pts", "{\n5 6\n7 8\n}\n");
  EXPECT_THAT(error(path("p"), true), HasSubstr("there is another file of frame 1"));
  write("q/face.pts", "{\n5 6\n7 8\n}\n");
  EXPECT_THAT(error(path("q"), true), HasSubstr("no file in this folder is named after its frame"));
  EXPECT_THAT(error_of([&] { read_landmarks({.path = path("q"), .scheme = "", .sparse = true}, 25); }), HasSubstr("q"));
}

TEST_F(LandmarksTest, MalformedPts) {
  const auto error = [&](const std::string& text) { return error_of([&] { read_pts(write("a.pts", text)); }); };
  EXPECT_THAT(error("version: 1\n{\n5\n}\n"), HasSubstr("a.pts:3: \"x y\" is expected"));
  EXPECT_THAT(error("{\n5 z\n}\n"), HasSubstr("a.pts:2: a number is expected, got \"z\""));
  EXPECT_THAT(error("{\n5 6\n"), HasSubstr("a.pts:2: breaks off before the \"}\""));
  EXPECT_THAT(error("version: 1\nn_points: 3\n{\n5 6\n}\n"),
              HasSubstr("a.pts:2: 3 points are promised here, 1 are there"));
  EXPECT_THAT(error("n_points: many\n{\n5 6\n}\n"), HasSubstr("a.pts:1: a number is expected"));
  EXPECT_THAT(error("n_points: 0\n"), HasSubstr("a.pts:1: a number of points is expected"));
  EXPECT_THAT(error(""), HasSubstr("a.pts: holds no points"));
  EXPECT_THAT(error_of([&] { read_pts(path("none.pts")); }), HasSubstr("none.pts: is missing"));
}

constexpr auto asf = R"(# AAM Shape File
#
# number of model points
2

# path type x y point from to
0 4 0.25 0.5 0 1 1
0 4 0.75 0.1 1 0 0

# host image
face.jpg
)";

TEST_F(LandmarksTest, AsfFolder) {
  write("p/01.asf", asf);
  length = 1;
  const auto track = read(path("p"));
  ASSERT_EQ(track.frames.size(), 1u);
  EXPECT_TRUE(track.frames[0].isApprox(shape(25, 25, 75, 5))) << "shares of 100 x 50 pixels";
  EXPECT_THAT(error_of([&] { read_landmarks({.path = path("p"), .scheme = ""}, 25); }),
              HasSubstr("this clip has no picture"));
}

TEST_F(LandmarksTest, MalformedAsf) {
  const auto error = [&](const std::string& text) {
    return error_of([&] { read_asf(write("a.asf", text), {10, 10}); });
  };
  EXPECT_THAT(error("# none\n"), HasSubstr("a.asf: holds no points"));
  EXPECT_THAT(error("#\ntwo\n"), HasSubstr("a.asf:2: a number is expected, got \"two\""));
  EXPECT_THAT(error("1\n0 4 0.5\n"), HasSubstr("a.asf:2: \"path type x y point from to\" is expected"));
  EXPECT_THAT(error("1\n0 4 0.5 y 0 1 1\n"), HasSubstr("a.asf:2: a number is expected, got \"y\""));
  EXPECT_THAT(error("1\n0 4 0.5 0.5 1 0 0\n"), HasSubstr("a.asf:2: a point is expected, 0 to 0, got \"1\""));
  EXPECT_THAT(error("2\n0 4 0.5 0.5 0 0 0\n0 4 0.5 0.5 0 0 0\n"), HasSubstr("a.asf:3: point 0 stands here again"));
  EXPECT_THAT(error("3\n0 4 0.5 0.5 0 0 0\n"), HasSubstr("a.asf:1: 3 points are promised here, 1 are there"));
}

TEST_F(LandmarksTest, Hdf5) {
  std::vector<Shape> shapes = {shape(1, 2, 3, 4), shape(5, 6, NAN, NAN)};
  Eigen::MatrixXd rows = (Eigen::MatrixXd(2, 4) << 1, 2, 3, 4, 5, 6, 7, 8).finished();
  Eigen::MatrixXd odd = Eigen::MatrixXd::Zero(2, 3);
  std::vector<Eigen::MatrixXd> deep = {Eigen::MatrixXd::Zero(2, 3)};
  write_hdf5(path("a.h5"), [&](Archive& ar) {
    ar("frames", shapes);
    ar("rows", rows);
    ar("odd", odd);
    ar("deep", deep);
  });
  const auto of = [&](const std::string& dataset, bool sparse = false) {
    return read_landmarks({path("a.h5"), "", dataset, sparse}, 25);
  };
  EXPECT_EQ(of("frames").frames[0], shapes[0]);
  EXPECT_TRUE(of("frames").frames[1].row(1).array().isNaN().all());
  EXPECT_EQ(of("rows").frames[1], shape(5, 6, 7, 8));
  for (const char* bad : {"odd", "deep"})
    EXPECT_THAT(error_of([&] { of(bad); }), HasSubstr("landmarks are frames x points x 2 or frames x 2 points")) << bad;
  EXPECT_THAT(error_of([&] { of("none"); }), HasSubstr("none: is missing"));
  EXPECT_THAT(error_of([&] { of("rows", true); }), HasSubstr("leave out \"sparse\""));
  EXPECT_THAT(error(write("b.h5", "x")), HasSubstr("b.h5: "));
}

TEST_F(LandmarksTest, ASchemeOfAnotherNumberOfPointsIsAnError) {
  EXPECT_THAT(error_of([&] {
                read_landmarks({write("a.csv", "1,2,3,4\n"), "face56"}, 25);
              }),
              HasSubstr("a.csv: holds 2 points, the scheme \"face56\" has 56"));
}

}  // namespace
}  // namespace talkgraph
