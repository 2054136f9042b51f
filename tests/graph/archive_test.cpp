#include "graph/archive.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/temporary_folder.h"

namespace talkgraph {

struct Part {
  double d = 0;
  std::vector<double> list;
};
void fields(Archive& ar, Part& p) {
  ar("d", p.d);
  ar("list", p.list);
}
struct Stretch {
  std::string label;
  double start = 0;
  std::int64_t count = 0;
};
template <>
inline constexpr bool is_row<Stretch> = true;
void fields(Archive& ar, Stretch& s) {
  ar("label", s.label);
  ar("start", s.start, "s");
  ar("count", s.count);
}
struct Whole {
  std::int64_t i = 0;
  bool yes = false;
  std::string text;
  std::vector<std::string> texts;
  std::vector<std::uint8_t> bytes;
  std::vector<std::int64_t> integers;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
  Rational rate{30000, 1001};
  std::optional<Part> some, none;
  std::vector<Part> parts;
  std::map<std::string, Part> named;
  std::vector<Stretch> rows, no_rows;
  std::vector<Eigen::MatrixXd> alike, unlike, no_matrices;
};
void fields(Archive& ar, Whole& w) {
  ar("i", w.i);
  ar("yes", w.yes);
  ar("text", w.text);
  ar("texts", w.texts);
  ar("bytes", w.bytes);
  ar("integers", w.integers);
  ar("matrix", w.matrix);
  ar("vector", w.vector);
  ar("rate", w.rate);
  ar("some", w.some);
  ar("none", w.none);
  ar("parts", w.parts);
  ar("named", w.named);
  ar("rows", w.rows);
  ar("no_rows", w.no_rows);
  ar("alike", w.alike);
  ar("unlike", w.unlike);
  ar("no_matrices", w.no_matrices);
}

namespace {

Whole example() {
  Whole w;
  w.i = -7;
  w.yes = true;
  w.text = "naïve \"text\"\n";
  w.texts = {"", "a", "bc"};
  w.bytes = {0, 255, 3};
  w.integers = {1, -2};
  w.matrix = Eigen::MatrixXd::Random(3, 5);
  w.vector = Eigen::VectorXd::LinSpaced(4, 0, 1);
  w.some = Part{1.5, {1, 2}};
  w.parts = {Part{2, {}}, Part{3, {4}}};
  w.named = {{"x/y", Part{5, {}}}};
  w.rows = {{"long label", 0.5, 3}, {"", -1, 4}};
  w.alike = {Eigen::MatrixXd::Random(2, 3), Eigen::MatrixXd::Random(2, 3)};
  w.unlike = {Eigen::MatrixXd::Random(2, 3), Eigen::MatrixXd(0, 3)};
  return w;
}

Key hash(Whole w) {
  return content_key([&](Archive& ar) { fields(ar, w); });
}

class ArchiveFile : public testing::Test {
 protected:
  const test::TemporaryFolder folder;
  const std::string path = folder.file("archive.h5");
};

TEST_F(ArchiveFile, RestoresEveryKindOfMember) {
  Whole w = example();
  write_hdf5(path, [&](Archive& ar) { ar("whole", w); });
  Whole back;
  back.none = Part{};
  back.no_rows = {{"gone", 1, 1}};
  back.named = {{"gone", {}}};
  (*hdf5_reader(path))("whole", back);
  EXPECT_EQ(hash(back), hash(w));
  EXPECT_EQ(back.matrix, w.matrix);
  EXPECT_EQ(back.texts, w.texts);
  EXPECT_EQ(back.rate, w.rate);
  EXPECT_EQ(back.some->list, w.some->list);
  EXPECT_EQ(back.named.at("x/y").d, 5);
  EXPECT_EQ(back.named.size(), 1u);
  ASSERT_EQ(back.rows.size(), 2u);
  EXPECT_EQ(back.rows[0].label, "long label");
  EXPECT_EQ(back.rows[1].count, 4);
  EXPECT_TRUE(back.no_rows.empty());
  EXPECT_EQ(back.alike, w.alike);
  EXPECT_EQ(back.unlike, w.unlike);
}

TEST_F(ArchiveFile, TheSameValueGivesTheSameBytes) {
  Whole w = example();
  write_hdf5(path, [&](Archive& ar) { ar("whole", w); });
  const std::string first = folder.read("archive.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // the times that HDF5 keeps are in seconds
  write_hdf5(path, [&](Archive& ar) { ar("whole", w); });
  EXPECT_EQ(folder.read("archive.h5"), first);
}

TEST_F(ArchiveFile, SaysWhatIsWrong) {
  const auto complaint = [&] {
    try {
      hdf5_reader(path);
    } catch (const std::runtime_error& e) {
      return std::string(e.what()).substr(path.size());
    }
    return std::string();
  };
  EXPECT_EQ(complaint(), ": is missing");
  folder.write("archive.h5", "");
  EXPECT_EQ(complaint(), ": is empty");
  folder.write("archive.h5", "not a model");
  EXPECT_EQ(complaint(), ": is not an HDF5 file");
  Part p;
  write_hdf5(path, [&](Archive& ar) { ar("part", p); });
  folder.write("archive.h5", folder.read("archive.h5").substr(0, 600));
  EXPECT_EQ(complaint(), ": is cut short, damaged, or being written");
  write_hdf5(path, [&](Archive& ar) { ar("part", p); });
  Whole w;
  try {
    (*hdf5_reader(path))("part", w);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/part/i"), std::string::npos) << e.what();
  }
}

TEST_F(ArchiveFile, MembersOfFixedSizeTakeNoOther) {
  Eigen::VectorXd pair = Eigen::VectorXd::LinSpaced(2, 1, 2), three = Eigen::VectorXd::Ones(3);
  Eigen::MatrixXd corners = Eigen::MatrixXd::Ones(4, 3);
  std::vector<Eigen::MatrixXd> pairs{pair, three};
  write_hdf5(path, [&](Archive& ar) {
    ar("pair", pair);
    ar("three", three);
    ar("corners", corners);
    ar("pairs", pairs);
  });
  const auto reader = hdf5_reader(path);
  Eigen::Vector2d v = Eigen::Vector2d::Zero();
  Eigen::RowVector2d row = Eigen::RowVector2d::Zero();
  Eigen::RowVectorXd any;
  (*reader)("pair", v);
  (*reader)("pair", row);
  (*reader)("three", any);
  EXPECT_EQ(v, Eigen::Vector2d(1, 2));
  EXPECT_EQ(row, Eigen::RowVector2d(1, 2));
  EXPECT_EQ(any, Eigen::RowVector3d::Ones());
  Eigen::Matrix<int, Eigen::Dynamic, 3> triangles;
  (*reader)("corners", triangles);
  EXPECT_EQ(triangles.rows(), 4);
  Eigen::Matrix<double, Eigen::Dynamic, 2> shape;
  std::vector<Eigen::Vector2d> list;
  EXPECT_THROW((*reader)("three", v), std::runtime_error);
  EXPECT_THROW((*reader)("three", row), std::runtime_error);
  EXPECT_THROW((*reader)("corners", shape), std::runtime_error);
  EXPECT_THROW((*reader)("pairs", list), std::runtime_error);
}

/// No file grows beyond `bytes` while this lives, as on a full disk.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~SmallDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST_F(ArchiveFile, IsWrittenWholeOrNotAtAll) {
  Part p{1, {2, 3}};
  write_hdf5(path, [&](Archive& ar) { ar("part", p); });
  const std::string first = folder.read("archive.h5");
  p.list.resize(20);
  for (const rlim_t room : {0, 100, 1000}) try {
      const SmallDisk disk(room);
      write_hdf5(path, [&](Archive& ar) { ar("part", p); });
      ADD_FAILURE() << room;
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()), path + ": cannot be written: File too large");
    }
  EXPECT_EQ(folder.read("archive.h5"), first);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "nothing half-written is left";
  EXPECT_THROW(write_hdf5(path, [](Archive&) { throw std::runtime_error("no value"); }), std::runtime_error);
  EXPECT_EQ(folder.read("archive.h5"), first);
}

TEST_F(ArchiveFile, ColumnsMustBeOfOneLength) {
  struct Uneven {
    std::vector<std::string> label = {"a"};
    std::vector<double> start = {1, 2};
    std::vector<std::int64_t> count = {1};
  } uneven;
  write_hdf5(path, [&](Archive& ar) {
    ar("label", uneven.label);
    ar("start", uneven.start);
    ar("count", uneven.count);
  });
  detail::Columns columns;
  Stretch example;
  fields(columns, example);
  try {
    columns.visit(*hdf5_reader(path));
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "the columns \"label\" and \"start\" of a file differ in length");
  }
}

TEST(Hash, TellsContentsApart) {
  Whole a = example(), b = example();
  EXPECT_EQ(hash(a), hash(b = a));
  b.matrix(2, 4) += 1e-15;
  EXPECT_NE(hash(a), hash(b));
  b = a;
  b.texts = {"", "ab", "c"};
  EXPECT_NE(hash(a), hash(b));
  b = a;
  b.rows[1].start = 0;
  EXPECT_NE(hash(a), hash(b));
  b = a;
  std::swap(b.alike[0], b.alike[1]);
  EXPECT_NE(hash(a), hash(b));
  b = a;
  b.matrix = Eigen::Map<Eigen::MatrixXd>(a.matrix.data(), 5, 3);
  EXPECT_NE(hash(a), hash(b));
}

}  // namespace
}  // namespace talkgraph
