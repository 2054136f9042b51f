#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "nodes/model/load.h"
#include "nodes/model/save.h"
#include "tests/temporary_folder.h"

namespace talkgraph {
namespace {

using testing::HasSubstr;

/// One triangle of one pixel that does not move.
AppearanceModel small_face() {
  AppearanceModel m;
  m.mean_shape = Shape{{0, 0}, {2, 0}, {0, 2}};
  m.triangles = Triangles{{0, 1, 2}};
  m.shape_modes.resize(6, 0);
  m.shape_per_mode.resize(6, 0);
  const auto textures = [](Eigen::Index columns) {
    return std::make_shared<const Eigen::MatrixXf>(Eigen::MatrixXf::Zero(3, columns));
  };
  m.texture_modes = textures(0);
  FitLevel level{{3, 3, 1, {0, 0}, m.mean_shape, {0}, {0}, {0}}, textures(1), textures(0), textures(4)};
  m.levels.push_back(level);
  return m;
}

class ModelFile : public testing::Test {
 protected:
  void SetUp() override {
    context.folder = folder.path();
    contexts.alphabet = {"aa", "b"};
    contexts.states = {{{}, {0.5, 0.5}, {0, 0}}};
    contexts.windows = {{"aa", 1}, {"b", 1}};
    mean.values = Eigen::RowVector3d(1, 2, 3);
    base.frames = video_from_frames({cv::Mat(4, 6, CV_8UC3, cv::Scalar(1, 2, 3))}, Rational(25));
  }
  std::string file() const { return folder.file("model.h5"); }

  const test::TemporaryFolder folder;
  Context context;
  AppearanceModel face = small_face();
  BaseClip base;
  Vlmm contexts;
  Ssgpdm states;
  Track mean;
  Mouths mouths{{3, 4},
                0.2,
                Eigen::MatrixXd::Ones(2, 3),
                {{cv::Mat(2, 4, CV_8UC3, cv::Scalar(1, 2, 3))}, {cv::Mat(2, 4, CV_8UC3, cv::Scalar(4, 5, 6))}}};
};

TEST_F(ModelFile, ComesBackInItsParts) {
  const SaveModel save{"model.h5", {"{\"nodes\": {}}"}};
  EXPECT_EQ(save(face, base, contexts, &states, nullptr, mean, &mouths, {}, context).path, "model.h5");
  EXPECT_FALSE(std::filesystem::exists(file() + ".part"));
  const TalkingFace back = LoadModel{{file()}}();
  EXPECT_EQ(back.contexts.alphabet, contexts.alphabet);
  EXPECT_TRUE(back.states);
  EXPECT_FALSE(back.process);
  EXPECT_EQ(back.mean.values, mean.values);
  ASSERT_EQ(back.mouths.pictures.size(), 2u);
  EXPECT_EQ(back.mouths.pictures[1].pixels.at<cv::Vec3b>(1, 2), cv::Vec3b(4, 5, 6));
  EXPECT_EQ(back.mouths.points, mouths.points);
  EXPECT_EQ(back.base.frames.read_all().at(0).at<cv::Vec3b>(3, 5), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(model_graph(file()), "{\"nodes\": {}}");
}

TEST_F(ModelFile, NeedsNoMouths) {
  SaveModel{}(face, base, contexts, &states, nullptr, mean, nullptr, {}, context);
  EXPECT_EQ(load_model(file()).mouths.size(), 0);
}

TEST_F(ModelFile, IsMovedByEither) {
  ContextGp process;
  process.audio_mean = process.audio_scale = process.window = Eigen::RowVectorXd::Ones(1);
  process.phones = {"aa"};
  process.map = Eigen::Matrix2d::Identity();
  process.lengths = {2};
  process.frames = Eigen::MatrixXd::Identity(2, 2);
  process.weights = Eigen::MatrixXd::Constant(2, 3, 0.5);
  process.mean = process.signal = Eigen::RowVectorXd::Ones(3);
  process.noise = 0.25;
  process.inducing = {1};
  process.certainty = Eigen::MatrixXd::Ones(1, 1);
  SaveModel{}(face, base, contexts, nullptr, &process, mean, nullptr, {}, context);
  const TalkingFace back = load_model(file());
  EXPECT_FALSE(back.states);
  ASSERT_TRUE(back.process);
  EXPECT_EQ(back.process->phones, process.phones);
  EXPECT_EQ(back.process->weights, process.weights);
  EXPECT_EQ(back.process->inducing, process.inducing);
  EXPECT_EQ(back.process->noise, 0.25);
  EXPECT_THROW(SaveModel{}(face, base, contexts, nullptr, nullptr, mean, nullptr, {}, context), std::invalid_argument);
}

TEST_F(ModelFile, SaysWhatIsWrongWithAFile) {
  const auto complaint = [&] {
    try {
      load_model(file());
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(complaint(), HasSubstr("there is no such model file"));
  double number = 1;
  write_hdf5(file(), [&](Archive& ar) { ar("number", number); });
  EXPECT_THAT(complaint(), HasSubstr("not a talkgraph model"));
  std::string format = "talkgraph model 99";
  write_hdf5(file(), [&](Archive& ar) { ar("format", format); });
  EXPECT_THAT(complaint(), HasSubstr("\"talkgraph model 99\""));
  SaveModel{}(face, base, contexts, &states, nullptr, mean, nullptr, {}, context);
  std::filesystem::resize_file(file(), std::filesystem::file_size(file()) / 2);
  EXPECT_THAT(complaint(), HasSubstr("model.h5"));
}

}  // namespace
}  // namespace talkgraph
