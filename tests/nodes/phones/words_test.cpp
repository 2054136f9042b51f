#include "nodes/phones/words.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

std::string said(std::string_view text) {
  std::string joined;
  for (const auto& word : spoken_words(text)) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

TEST(SpokenWords, DropPunctuationAndCase) {
  EXPECT_EQ(said("Well-known, isn't it? \"Yes\" \xe2\x80\x94 it\xe2\x80\x99s the dogs'."),
            "well known isn't it yes it's the dogs");
  EXPECT_EQ(said(""), "");
  EXPECT_EQ(said(" \n\t .,;"), "");
  EXPECT_EQ(said("\u00abOne\u00bb\u00a0two\u202fthree \u2022 four\u2212five\u3000six \U0001f600"),
            "one two three four five six");
  EXPECT_EQ(said("na\u00efve caf\u00e9 \u00a3 \u20ac\xc2"), "na\u00efve caf\u00e9")
      << "letters stay, even at a cut end";
}

TEST(SpokenWords, SpellOutNumbers) {
  EXPECT_EQ(said("2"), "two");
  EXPECT_EQ(said("25"), "twenty five");
  EXPECT_EQ(said("0"), "zero");
  EXPECT_EQ(said("110"), "one hundred ten");
  EXPECT_EQ(said("1,000,001"), "one million one");
  EXPECT_EQ(said("3.14"), "three point one four");
  EXPECT_EQ(said("007"), "zero zero seven");
  EXPECT_EQ(said("bin at f2 now"), "bin at f two now");
  EXPECT_EQ(said("40% & more"), "forty percent and more");
}

TEST(SpokenWords, ReadYearsInHalves) {
  EXPECT_EQ(said("1984"), "nineteen eighty four");
  EXPECT_EQ(said("1905"), "nineteen oh five");
  EXPECT_EQ(said("1900, the 1800s"), "nineteen hundred the eighteen hundreds");
  EXPECT_EQ(said("2000"), "two thousand");
  EXPECT_EQ(said("2015"), "twenty fifteen");
  EXPECT_EQ(said("1,984"), "one thousand nine hundred eighty four");
}

TEST(SpokenWords, SpellOutDecades) {
  EXPECT_EQ(said("the 1990s, the 60s"), "the nineteen nineties the sixties");
  EXPECT_EQ(said("5s 6s"), "fives sixes");
}

TEST(SpokenWords, SpellOutMoney) {
  EXPECT_EQ(said("$5"), "five dollars");
  EXPECT_EQ(said("$1, \u00a31 or \u20ac20."), "one dollar one pound or twenty euros");
  EXPECT_EQ(said("$3.50"), "three dollars fifty");
  EXPECT_EQ(said("$3.00"), "three dollars");
  EXPECT_EQ(said("$3.5 million"), "three point five million dollars");
  EXPECT_EQ(said("\u00a32,000"), "two thousand pounds");
  EXPECT_EQ(said("$ and $x"), "and x");
}

TEST(SpokenWords, SpellOutOrdinals) {
  EXPECT_EQ(said("1st 2nd 3rd 5th 12th 20th 21st 100th"),
            "first second third fifth twelfth twentieth twenty first one hundredth");
}

}  // namespace
}  // namespace talkgraph
