#include "nodes/corpus/tables.h"

#include "graph/archive.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using TablesTest = MediaTest;

template <class T>
std::string npy(const std::string& type, const std::string& shape, const std::vector<T>& values,
                const std::string& order = "False") {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  header.resize(117, ' ');
  header += '\n';
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return bytes;
}

const Eigen::MatrixXd kValues = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6.5).finished();

TEST_F(TablesTest, CsvWithAndWithoutNames) {
  const auto named = read_table(write("a.csv", "x,y,z\n1,2,3\r\n\n4, 5,6.5\n"), "");
  EXPECT_THAT(named.names, ElementsAre("x", "y", "z"));
  EXPECT_EQ(named.values, kValues);
  EXPECT_THAT(read_csv(write("e.csv", "e,E\n1,2\n")).names, ElementsAre("e", "E"));
  EXPECT_TRUE(std::isnan(read_csv(write("n.csv", "nan,nan\n1,2\n")).values(0, 1))) << "no header";
  EXPECT_EQ(read_table(write("b.csv", "1,2,3\n4,5,65e-1\n"), "").values, kValues);
}

TEST_F(TablesTest, CsvErrorsNameTheLine) {
  EXPECT_THAT(error_of([&] { read_csv(write("a.csv", "x,y\n1,2\n1\n")); }), HasSubstr("a.csv:3: 2 columns"));
  EXPECT_THAT(error_of([&] { read_csv(write("b.csv", "x,y\n1,2\n1,u\n")); }), HasSubstr("b.csv:3: a number"));
  EXPECT_THAT(error_of([&] { read_csv(write("c.csv", "1,2\n1,inf\n")); }), HasSubstr("c.csv:2: a number"));
  EXPECT_THAT(error_of([&] { read_table(write("f.csv", "nan,nan\n1,2\n"), ""); }),
              HasSubstr("f.csv:1: frame 0 holds a number that is not finite"));
  EXPECT_THAT(error_of([&] { read_csv(write("g.csv", "1,u\n1,2\n")); }), HasSubstr("g.csv:1: a number is expected"));
  EXPECT_THAT(error_of([&] { read_csv(write("d.csv", "x,y\n")); }), HasSubstr("d.csv: holds no numbers"));
  EXPECT_THAT(error_of([&] { read_csv(write("e.csv", "")); }), HasSubstr("e.csv: holds no numbers"));
  EXPECT_THAT(error_of([&] { read_csv(path("none.csv")); }), HasSubstr("none.csv: is missing"));
}

TEST_F(TablesTest, Npy) {
  const std::vector<double> doubles = {1, 2, 3, 4, 5, 6.5};
  const std::vector<float> floats(doubles.begin(), doubles.end());
  EXPECT_EQ(read_table(write("d.npy", npy("<f8", "(2, 3)", doubles)), "").values, kValues);
  EXPECT_EQ(read_table(write("f.npy", npy("<f4", "(2, 3)", floats)), "").values, kValues);
  EXPECT_EQ(read_npy(write("v.npy", npy("<f8", "(6,)", doubles))).rows(), 6);
}

TEST_F(TablesTest, NpyErrors) {
  const std::vector<double> v = {1, 2, 3, 4, 5, NAN};
  EXPECT_THAT(error_of([&] { read_npy(write("a.npy", "text")); }), HasSubstr("is not a .npy file"));
  EXPECT_THAT(error_of([&] { read_npy(write("b.npy", npy("<i8", "(2, 3)", v))); }), HasSubstr("holds '<i8'"));
  EXPECT_THAT(error_of([&] { read_npy(write("c.npy", npy("<f8", "(2, 3)", v, "True"))); }), HasSubstr("Fortran"));
  EXPECT_THAT(error_of([&] { read_npy(write("d.npy", npy("<f8", "(3, 3)", v))); }), HasSubstr("breaks off: 3 x 3"));
  EXPECT_THAT(error_of([&] { read_npy(write("e.npy", npy("<f8", "(1, 2, 3)", v))); }), HasSubstr("has the shape"));
  EXPECT_THAT(error_of([&] { read_npy(write("f.npy", npy("<f8", "(99999999999, 99999999)", v))); }),
              HasSubstr("breaks off"));
  EXPECT_THAT(error_of([&] { read_table(write("g.npy", npy("<f8", "(2, 3)", v)), ""); }), HasSubstr("frame 1 holds"));
  EXPECT_THAT(error_of([&] { read_table(write("h.npy", npy("<f8", "(0, 3)", v)), ""); }), HasSubstr("no numbers"));
}

TEST_F(TablesTest, Hdf5) {
  Eigen::MatrixXd values = kValues;
  write_hdf5(path("a.h5"), [&](Archive& ar) { ar("blend", values); });
  EXPECT_EQ(read_table(path("a.h5"), "blend").values, kValues);
  EXPECT_THAT(error_of([&] { read_table(path("a.h5"), "other"); }), HasSubstr("other: is missing"));
  EXPECT_THAT(error_of([&] { read_table(write("b.h5", "x"), "blend"); }), HasSubstr("b.h5: "));
  EXPECT_THAT(error_of([&] { read_table(write("c.xls", "x"), ""); }), HasSubstr("c.xls: a track is read from"));
}

}  // namespace
}  // namespace talkgraph
