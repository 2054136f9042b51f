#include "runtime/keys.h"

#include <gtest/gtest.h>

#include <string>

namespace talkgraph {
namespace {

TEST(Keys, MayComeInAnyOrder) {
  Keys keys;
  for (const char* key : {"b", "c", "aa", "a", "bb", "ab"}) EXPECT_TRUE(keys.add(key)) << key;
  for (const char* key : {"c", "b", "ab", "a", "aa", "bb"}) EXPECT_FALSE(keys.add(key)) << key;
  EXPECT_TRUE(keys.add("d"));
  EXPECT_EQ(keys.size(), 7u);
}

TEST(Keys, AreKeptInOrderEachOnce) {
  Keys keys;
  EXPECT_TRUE(keys.empty());
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(keys.add(std::to_string(i)));
  const std::string* first = &keys[0];
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(keys.add(std::to_string(i)));
  EXPECT_TRUE(keys.add(""));
  EXPECT_FALSE(keys.add(""));
  EXPECT_EQ(keys.size(), 1001u);
  for (std::size_t i = 0; i < 1000; ++i) EXPECT_EQ(keys[i], std::to_string(i));
  EXPECT_EQ(keys.back(), "");
  EXPECT_EQ(first, &keys[0]);
}

}  // namespace
}  // namespace talkgraph
