#include <gtest/gtest.h>

#include "nodes/face/fit.h"
#include "synthetic_face.h"
#include "tests/nodes/types/changed_members.h"

namespace talkgraph {
namespace {

TEST(StoredModels, OfAFaceFitTogetherOrAreRefused) {
  const cv::Mat picture = test::draw({});
  const auto use = [&](const AppearanceModel& m) {
    Pyramid pyramid(picture);
    Fitter fitter(m);
    Fit start;
    start.c = Eigen::VectorXd::Zero(m.modes());
    start.pose.dx = 100;
    start.pose.dy = 95;
    const Fit fit = fitter.coarse_to_fine(pyramid, start);
    Eigen::MatrixXd answer = m.shape(fit.c);
    answer(0, 0) += static_cast<double>(m.texture(fit.c).sum());
    return answer;
  };
  EXPECT_GT(testing::refuses_or_answers<AppearanceModel>(test::model(), use), 80);
}

}  // namespace
}  // namespace talkgraph
