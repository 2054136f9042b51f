#include "nodes/mapping/phone_inventory.h"

#include <gtest/gtest.h>

namespace talkgraph {
namespace {

TEST(PhoneInventory, IsSortedAndFindsItsPhones) {
  const auto inventory = phone_inventory({"t", "aa", "sil", "aa", "t", "t"});
  EXPECT_EQ(inventory, (std::vector<std::string>{"aa", "sil", "t"}));
  EXPECT_EQ(place_of(inventory, "aa"), 0);
  EXPECT_EQ(place_of(inventory, "t"), 2);
  for (const char* unmet : {"", "b", "zh"}) EXPECT_EQ(place_of(inventory, unmet), 3) << unmet;
  EXPECT_TRUE(phone_inventory({}).empty());
  EXPECT_EQ(place_of({}, "aa"), 0);
}

}  // namespace
}  // namespace talkgraph
