#include "study/range.h"

#include <gtest/gtest.h>

namespace talkgraph::study {
namespace {

void expect(const char* header, std::size_t size, std::size_t first, std::size_t length) {
  const auto range = range_of(header, size);
  ASSERT_TRUE(range) << header;
  EXPECT_EQ(range->length, length) << header;
  if (length > 0) {
    EXPECT_EQ(range->first, first) << header;
  }
}

TEST(Range, IsCutToWhatThereIs) {
  expect("bytes=0-0", 10, 0, 1);
  expect("bytes=2-5", 10, 2, 4);
  expect("bytes=7-", 10, 7, 3);
  expect("bytes=-3", 10, 7, 3);
  expect("bytes=-30", 10, 0, 10);
  expect("bytes=9-18446744073709551615", 10, 9, 1);
}

TEST(Range, HasNothingBeyondTheEnd) {
  expect("bytes=10-", 10, 0, 0);
  expect("bytes=10-12", 10, 0, 0);
  expect("bytes=-0", 10, 0, 0);
  expect("bytes=0-", 0, 0, 0);
}

TEST(Range, WhatCannotBeReadAsksForAll) {
  for (const char* header : {"", "bytes", "bytes=", "bytes=-", "bytes=5-2", "bytes=1-2,4-5", "bytes=a-b", "bytes=+1-2",
                             "items=0-1", "bytes= 0-1", "bytes=1--2", "bytes=99999999999999999999999-"})
    EXPECT_FALSE(range_of(header, 10)) << header;
}

}  // namespace
}  // namespace talkgraph::study
