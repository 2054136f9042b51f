#include "nodes/corpus/labels.h"

#include "nodes/corpus/text.h"
#include "nodes/phones/label_files.h"
#include "tests/nodes/media/media_test.h"

namespace talkgraph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using LabelsTest = MediaTest;

std::string shown(const std::vector<Interval>& intervals) {
  std::string text;
  char part[100];
  for (const auto& i : intervals) {
    std::snprintf(part, sizeof part, "%s %.4f-%.4f, ", i.label.c_str(), i.start, i.end);
    text += part;
  }
  return text;
}

TEST(NormalisedPhone, LowerCaseWithoutStress) {
  EXPECT_EQ(normalised_phone("AH0"), "ah");
  EXPECT_EQ(normalised_phone(" zh "), "zh");
  for (const char* pause : {"", "sil", "SIL", "sp", "pau", "#", "h#", "<p:>", " "})
    EXPECT_EQ(normalised_phone(pause), "sil");
  EXPECT_EQ(normalised_phone("breath"), "breath");
  EXPECT_EQ(normalised_phone("oo"), "oo");
}

const std::vector<Interval> kPhones = {{"sil", 0, 0.1}, {"b", 0.1, 0.18}, {"ih", 0.18, 0.26}, {"n", 0.26, 0.4}};

TEST_F(LabelsTest, HtkLabelsGoRound) {
  EXPECT_EQ(shown(read_phones(write("a.lab", htk_labels(kPhones))).phones), shown(kPhones));
}

TEST_F(LabelsTest, TextGridsGoRoundInEveryEncoding) {
  const std::string text = text_grid({{"words", {{"bin", 0.1, 0.4}}}, {"phones", kPhones}});
  EXPECT_EQ(shown(read_phones(write("a.TextGrid", text)).phones), shown(kPhones));
  EXPECT_EQ(shown(read_words(write("a.TextGrid", text)).words), "sil 0.0000-0.1000, bin 0.1000-0.4000, ");
  std::string little = "\xff\xfe", big = "\xfe\xff";
  for (const char c : text) little += std::string{c, '\0'}, big += std::string{'\0', c};
  EXPECT_EQ(shown(read_phones(write("b.TextGrid", little)).phones), shown(kPhones));
  EXPECT_EQ(shown(read_phones(write("c.TextGrid", big)).phones), shown(kPhones));
}

TEST_F(LabelsTest, ShortTextGrid) {
  const std::string text =
      "File type = \"ooTextFile\"\nObject class = "
      "\"TextGrid\"\n\n0\n0.4\n<exists>\n1\n\"IntervalTier\"\n\"any\"\n0\n0.4\n"
      "2\n0\n0.1\n\"\"\n0.1\n0.4\n\"AA1\"\n";
  EXPECT_EQ(shown(read_phones(write("a.textgrid", text)).phones), "sil 0.0000-0.1000, aa 0.1000-0.4000, ");
}

TEST_F(LabelsTest, TheTierIsChosenByName) {
  const std::string text = text_grid({{"s1 - words", {{"x", 0, 1}}}, {"s1 - phones", {{"k", 0, 1}}}});
  EXPECT_EQ(read_phones(write("a.TextGrid", text)).phones.at(0).label, "k");
  const std::string other = text_grid({{"a", {{"x", 0, 1}}}, {"b", {{"k", 0, 1}}}});
  EXPECT_THAT(error_of([&] { read_phones(write("b.TextGrid", other)); }),
              HasSubstr("b.TextGrid: has no interval tier \"phones\"; it has \"a\", \"b\""));
}

TEST_F(LabelsTest, GapsAndNeighbouringSilencesBecomeOneSilence) {
  const auto phones =
      read_phones(write("a.lab", "1000000 2000000 K\n2000000 3000000 sp\n4000000 5000000 AE1\n")).phones;
  EXPECT_EQ(shown(phones), "sil 0.0000-0.1000, k 0.1000-0.2000, sil 0.2000-0.4000, ae 0.4000-0.5000, ");
}

TEST_F(LabelsTest, GridWordTimes) {
  const auto words = read_words(write("a.align", "0 23750 sil\r\n23750 29500 Bin\n29500 34000 sp\n34000 35500 at\n"));
  EXPECT_EQ(shown(words.words), "sil 0.0000-0.9500, bin 0.9500-1.1800, sil 1.1800-1.3600, at 1.3600-1.4200, ");
  EXPECT_EQ(transcript_of(words).text, "bin at");
}

TEST_F(LabelsTest, ErrorsNameTheLine) {
  EXPECT_THAT(error_of([&] { read_words(write("a.align", "0 1 sil\n1 2\n")); }),
              HasSubstr("a.align:2: \"start end word\""));
  EXPECT_THAT(error_of([&] { read_words(write("b.align", "0 1 a\n\n1 x b\n")); }), HasSubstr("b.align:3: a number"));
  EXPECT_THAT(error_of([&] { read_words(write("c.align", "0 5 a\n4 6 b\n")); }),
              HasSubstr("c.align:2: the interval starts"));
  EXPECT_THAT(error_of([&] { read_words(write("d.align", "5 4 a\n")); }), HasSubstr("d.align:1: the interval ends"));
  EXPECT_THAT(error_of([&] { read_words(write("e.align", "")); }), HasSubstr("holds no labels"));
  EXPECT_THAT(error_of([&] { read_phones(write("f.lab", "0 x aa\n")); }), HasSubstr("f.lab:1: "));
  EXPECT_THAT(error_of([&] { read_phones(write("g.doc", "0 1 aa\n")); }), HasSubstr("g.doc: labels are read from"));
  EXPECT_THAT(error_of([&] { read_phones(path("none.lab")); }), HasSubstr("none.lab: is missing"));
}

TEST_F(LabelsTest, TextFilesBecomeUtf8) {
  EXPECT_EQ(read_text_file(write("a", "\xef\xbb\xbfx")), "x");
  EXPECT_EQ(read_text_file(write("b", std::string("\xff\xfe\xe9\0\x3d\xd8\0\xde", 8))), "é😀");
}

}  // namespace
}  // namespace talkgraph
