#include "nodes/types/paired.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace talkgraph {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Track zeros(Eigen::Index frames, Eigen::Index dimensions) {
  Track track;
  track.values.setZero(frames, dimensions);
  return track;
}

TEST(SideBySide, JoinsWhatBothStreamsHave) {
  Track sound = zeros(4, 2), face = zeros(3, 1);
  sound.values(2, 1) = 5;
  face.values(2, 0) = 7;
  face.lost = {1};
  const auto both = side_by_side({{"a", sound}, {"b", sound}}, {{"a", face}, {"c", face}});
  ASSERT_EQ(both.tracks.keys(), std::vector<std::string>{"a"});
  EXPECT_EQ(both.audio, 2);
  EXPECT_EQ(both.tracks[0].values.row(2), Eigen::RowVector3d(0, 5, 7));
  EXPECT_EQ(both.tracks[0].frames(), 3);
  EXPECT_EQ(both.tracks[0].lost, face.lost);
}

TEST(SideBySide, NamesTheStreamWhoseDimensionsDiffer) {
  const auto join = [](const Track& sound, const Track& face) {
    return [=] { side_by_side({{"a", zeros(4, 2)}, {"b", sound}}, {{"a", zeros(4, 3)}, {"b", face}}); };
  };
  EXPECT_THAT(join(zeros(4, 1), zeros(4, 3)),
              ThrowsMessage<std::runtime_error>(HasSubstr("b: 1 audio dimensions, those before it 2")));
  EXPECT_THAT(join(zeros(4, 2), zeros(4, 4)),
              ThrowsMessage<std::runtime_error>(HasSubstr("b: 4 visual dimensions, those before it 3")));
  EXPECT_THAT(join(zeros(9, 2), zeros(4, 3)), ThrowsMessage<std::runtime_error>(HasSubstr("bring both to one rate")));
  EXPECT_THAT([] { side_by_side({}, {}); }, ThrowsMessage<std::runtime_error>(HasSubstr("selection empty")));
}

}  // namespace
}  // namespace talkgraph
