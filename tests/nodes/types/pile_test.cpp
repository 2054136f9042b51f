#include "nodes/types/pile.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

struct Inner {
  Eigen::MatrixXd matrix;
  std::vector<std::string> names;
};
void fields(Archive& ar, Inner& i) {
  ar("matrix", i.matrix);
  ar("names", i.names);
}

struct Thing {
  std::string label;
  double number = 0;
  std::int64_t count = 0;
  bool flag = false;
  std::vector<double> numbers;
  std::vector<std::int64_t> counts;
  std::vector<Eigen::MatrixXd> matrices;
  std::optional<Inner> inner;
};
void fields(Archive& ar, Thing& t) {
  ar("label", t.label);
  ar("number", t.number);
  ar("count", t.count);
  ar("flag", t.flag);
  ar("numbers", t.numbers);
  ar("counts", t.counts);
  ar("matrices", t.matrices);
  ar("inner", t.inner);
}

struct Things {
  std::vector<Thing> all;
};
void fields(Archive& ar, Things& t) {
  std::size_t size = t.all.size();
  if (ar.loading()) t.all.clear();
  Pile::keep(ar, "things", size,
             [&](Archive& pile, std::size_t i) { fields(pile, ar.loading() ? t.all.emplace_back() : t.all[i]); });
}

Things some() {
  Things t;
  t.all = {
      {"a", 1.5, 3, true, {1, 2}, {}, {Eigen::MatrixXd::Random(2, 3)}, Inner{Eigen::MatrixXd::Random(3, 2), {"x"}}},
      {"", -0.25, -7, false, {}, {4, 5, 6}, {}, std::nullopt},
      {"c", 0, 0, true, {9}, {1}, {Eigen::MatrixXd(0, 4), Eigen::MatrixXd::Random(1, 1)}, Inner{}}};
  return t;
}

Key hash(Things& t) {
  return content_key([&](Archive& ar) { fields(ar, t); });
}

TEST(Pile, GivesBackWhatItWasGiven) {
  const test::TemporaryFolder folder;
  for (Things saved : {some(), Things{}}) {
    Things loaded;
    write_hdf5(folder.file("things.h5"), [&](Archive& ar) { fields(ar, saved); });
    fields(*hdf5_reader(folder.file("things.h5")), loaded);
    ASSERT_EQ(loaded.all.size(), saved.all.size());
    EXPECT_EQ(hash(loaded), hash(saved));
    for (std::size_t i = 0; i < saved.all.size(); ++i) {
      EXPECT_EQ(loaded.all[i].label, saved.all[i].label);
      EXPECT_EQ(loaded.all[i].numbers, saved.all[i].numbers);
      EXPECT_EQ(loaded.all[i].counts, saved.all[i].counts);
      ASSERT_EQ(loaded.all[i].inner.has_value(), saved.all[i].inner.has_value());
      if (saved.all[i].inner) {
        EXPECT_EQ(loaded.all[i].inner->matrix, saved.all[i].inner->matrix);
      }
    }
  }
}

TEST(Pile, TellsDifferentValuesApart) {
  Things a = some(), b = some();
  b.all[2].matrices[0].resize(4, 0);
  EXPECT_NE(hash(a), hash(b));
}

TEST(Pile, SaysWhatAFileOfOtherValuesLacks) {
  const test::TemporaryFolder folder;
  write_hdf5(folder.file("other.h5"), [](Archive& ar) {
    std::size_t size = 1;
    double number = 1;
    Pile::keep(ar, "things", size, [&](Archive& pile, std::size_t) { pile("number", number); });
  });
  Things loaded;
  try {
    fields(*hdf5_reader(folder.file("other.h5")), loaded);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("\"label\""), std::string::npos) << e.what();
  }
}

TEST(Pile, LongListsOfRoundedNumbersTakeHalfTheRoomAndComeBackExactly) {
  const test::TemporaryFolder folder;
  std::vector<double> numbers(100000), loaded;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(std::sin(i)) > 0 ? i * 0.125 : -3.5;
  write_hdf5(folder.file("numbers.h5"), [&](Archive& ar) { ar("numbers", numbers); });
  (*hdf5_reader(folder.file("numbers.h5")))("numbers", loaded);
  EXPECT_EQ(loaded, numbers);
  EXPECT_LT(std::filesystem::file_size(folder.file("numbers.h5")), 400000u);
}

}  // namespace
}  // namespace talkgraph
