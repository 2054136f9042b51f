#include "nodes/mapping/phone_chain.h"

#include <gtest/gtest.h>

#include "tests/nodes/types/changed_members.h"

namespace talkgraph {
namespace {

TEST(PhoneChain, CountsByHand) {
  const PhoneChain chain = phone_chain({"b", "a", "a", "b", "b"}, {3, 2});
  EXPECT_EQ(chain.phones, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(chain.start.isApprox(Eigen::Vector2d(1.0 / 4, 3.0 / 4)));
  Eigen::MatrixXd expected(2, 2);
  expected << 2.0 / 3, 1.0 / 3, 2.0 / 4, 2.0 / 4;
  EXPECT_TRUE(chain.transitions.isApprox(expected));
}

TEST(PhoneChain, OfOnePhoneStaysThere) {
  const PhoneChain chain = phone_chain({"a"}, {1});
  EXPECT_EQ(chain.start[0], 1);
  EXPECT_EQ(chain.transitions(0, 0), 1);
}

TEST(PhoneChain, WithoutPhonesIsRefused) {
  PhoneChain none{{}, Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)}, loaded;
  testing::MemoryArchive archive;
  fields(archive, none);
  archive.loads = true;
  EXPECT_THROW(fields(archive, loaded), std::runtime_error);
}

}  // namespace
}  // namespace talkgraph
