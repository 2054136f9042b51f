#include "nodes/write/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

const char* const kSquare = R"(<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">
<rect x="10" y="5" width="10" height="10" fill="#ff0000"/><text x="25" y="15" font-size="12">M</text></svg>)";

class WritePlots : public testing::Test {
 protected:
  void SetUp() override { context.folder = folder.path(); }
  std::string read(const std::string& name) const { return folder.read(name); }
  std::string complaint(const Plot& plot, const WritePlot& node) {
    try {
      node(plot, context);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "none";
  }

  const test::TemporaryFolder folder;
  Context context;
};

TEST_F(WritePlots, AsTheyAre) {
  const Plot plot{"p", "<svg></svg>"};
  EXPECT_EQ((WritePlot{"one"}(plot, context)).path, "plots/one.svg");
  EXPECT_EQ(read("plots/one.svg"), "<svg></svg>");
  EXPECT_THROW(WritePlot{}(plot, context), std::invalid_argument);
  context.item = "clip";
  EXPECT_EQ(WritePlot{}(plot, context).path, "plots/clip.svg");
}

TEST_F(WritePlots, DrawsPictures) {
  const Artifact file = WritePlot{"p", "plots", PlotFormat::png, 3}({"", kSquare}, context);
  EXPECT_EQ(file.path, "plots/p.png");
  const cv::Mat picture = cv::imread(folder.file(file.path));
  ASSERT_EQ(picture.size(), cv::Size(120, 60));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(255, 255, 255)) << "on white";
  EXPECT_EQ(picture.at<cv::Vec3b>(30, 45), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(picture.at<cv::Vec3b>(30, 62), cv::Vec3b(255, 255, 255)) << "the square ends at 60";
  cv::Mat darkest;
  cv::reduce(picture.reshape(1)(cv::Rect(3 * 75, 0, 3 * 45, 60)), darkest, 0, cv::REDUCE_MIN);
  double least = 255;
  cv::minMaxLoc(darkest, &least);
  EXPECT_LT(least, 64) << "there is no font to write the M with: fonts-dejavu-core";
}

TEST_F(WritePlots, SaysWhatCannotBeDrawn) {
  const WritePlot png{"p", "plots", PlotFormat::png};
  EXPECT_THAT(complaint({"", "no picture"}, png), HasSubstr("plots/p.png: the plot cannot be drawn: "));
  EXPECT_THAT(complaint({"", ""}, png), HasSubstr("p.png: the plot cannot be drawn"));
  EXPECT_THAT(complaint({"", R"(<svg xmlns="http://www.w3.org/2000/svg" width="1e5" height="9"/>)"}, png),
              HasSubstr("lower \"scale\""));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "plots" / "p.png"));
  context.folder = folder.write("in_the_way", "x");
  EXPECT_THAT(complaint({"", kSquare}, png), HasSubstr("in_the_way"));
}

}  // namespace
}  // namespace talkgraph
