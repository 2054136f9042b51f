#include "nodes/report/latent_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nodes/latent/predictive.h"
#include "tests/nodes/plot/latent_models.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using test::bent_state;
using testing::HasSubstr;
using testing::Not;

class LatentPageTest : public testing::Test {
 protected:
  void SetUp() override { context.folder = folder.path(); }
  std::string page(const Sgpdm& state, const Collected<Track>& paths = {}) {
    EXPECT_EQ(node(Value::of(state), {}, paths, {}, context).path, "latent-space.html");
    return folder.read("latent-space.html");
  }
  static Json data_of(const std::string& page) {
    const std::string open = "<script id=\"data\" type=\"application/json\">";
    const auto from = page.find(open) + open.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  const test::TemporaryFolder folder;
  Context context;
  LatentPage node;
};

TEST_F(LatentPageTest, HasPointsPhonesAndPrecision) {
  const Sgpdm state = bent_state("k-ae-t", 4, 3);
  node.dimensions = {2, 1, 3};
  const Json data = data_of(page(state));
  Predictive predictive;
  predictive.compute(state.visual, state.latents);
  for (Eigen::Index t = 0; t < 12; ++t) {
    const auto i = static_cast<std::size_t>(t);
    EXPECT_NEAR(data["points"][i][0].get<double>(), state.latents(t, 1), 1e-4);
    EXPECT_NEAR(data["points"][i][2].get<double>(), state.latents(t, 2), 1e-4);
    EXPECT_NEAR(data["precision"][i].get<double>(), -std::log(predictive.variance()[t]), 1e-3);
    EXPECT_EQ(data["labels"][data["label"][i].get<std::size_t>()], (std::array{"k", "ae", "t"}[i % 3]));
  }
  const double n = node.resolution, least = data["least"], range = data["surest"].get<double>() - least;
  const std::vector<double> low = data["low"], high = data["high"];
  const auto middle_of = [&](std::size_t axis, double k) {
    return low[axis] + (high[axis] - low[axis]) * (k + 0.5) / n;
  };
  Eigen::RowVector3d x(middle_of(1, 3), middle_of(0, 2), middle_of(2, 5));
  predictive.compute(state.visual, x);
  const double cell = data["cloud"][static_cast<std::size_t>(2 + n * (3 + n * 5))];
  EXPECT_NEAR(cell / 255 * range + least, -std::log(predictive.variance()[0]), range / 255);
}

TEST_F(LatentPageTest, NeedsNothingElseAndTellsTheSameInNumbers) {
  const std::string text = page(bent_state("k-ae-t", 4, 3));
  for (const char* outside : {"http:", "https:", "src=", "<link", "@import", "url("})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
  EXPECT_THAT(text, Not(HasSubstr("{{")));
  EXPECT_THAT(text, HasSubstr("k-ae-t: 12 frames in 4 windows; phones ae, k, t."));
  EXPECT_THAT(text, HasSubstr("<th scope=\"row\">ae</th><td>4</td>"));
}

TEST_F(LatentPageTest, KeepsLabelsFromBecomingMarkup) {
  const std::string evil = "</script><script>alert(\"{{data}}\")</script>\xff";
  const std::string text = page(bent_state(evil, 2, 3));
  EXPECT_THAT(text, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(text, HasSubstr("&lt;script&gt;alert(&quot;{{data}}&quot;)"));
  EXPECT_THAT(data_of(text)["labels"][0].get<std::string>(), HasSubstr("</script><script>alert(\"{{data}}\")"));
}

TEST_F(LatentPageTest, DrawsDegenerateModelsAndPaths) {
  for (const auto& state : {bent_state("t", 1, 1), bent_state("t", 3, 4, 1), bent_state("t", 3, 4, 2)}) {
    const Json data = data_of(page(state));
    for (const char* name : {"points", "precision", "cloud"})
      EXPECT_EQ(data[name].dump().find("null"), std::string::npos) << "a number that is not finite";
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_LT(data["low"][axis].get<double>(), data["high"][axis].get<double>());
  }
  EXPECT_EQ(data_of(page(bent_state("t", 3, 4, 1)))["axes"], Json({"latent dimension 1", "frame of the window", ""}));
  Track path;
  path.values = Eigen::MatrixXd::Constant(2, 3, 9);
  const Json data = data_of(page(bent_state("t", 3, 4), {{"a", path}}));
  EXPECT_EQ(data["paths"][0].size(), 2u);
  EXPECT_GT(data["high"][0].get<double>(), 9);
}

TEST_F(LatentPageTest, RefusesUnknownStates) {
  node.state = "k-ae-d";
  EXPECT_THROW(page(bent_state("k-ae-t", 2, 3)), std::invalid_argument);
  node.state = "";
  node.dimensions = {1, 2};
  EXPECT_THROW(page(bent_state("k-ae-t", 2, 3)), std::invalid_argument);
}

}  // namespace
}  // namespace talkgraph
