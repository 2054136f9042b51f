#pragma once

#include <memory>

#include "nodes/face/mouth_region.h"
#include "nodes/types/appearance_model.h"
#include "nodes/types/eyes.h"
#include "nodes/types/mouths.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What a face shows in one frame.
struct Look {
  Shape shape;              ///< model frame
  Eigen::VectorXf texture;  ///< normalised, of the finest raster
};

/// What a face shows in every frame: what the model makes of its appearance
/// parameters, the eyes of others and real mouths if they are given.
class Looks {
 public:
  /// Eyes and mouths may be null. Throws std::runtime_error if parameters, eyes or mouths were made with another
  /// model, are of another length, name points that the model lacks, or hold a value that is not finite.
  Looks(AppearanceModel model, Track parameters, const Eyes* eyes, const MouthTrack* mouths);

  const AppearanceModel& model() const { return model_; }
  const Track& parameters() const { return parameters_; }
  Look at(Eigen::Index t) const;
  /// The frames from `first` on, as many as `looks` has, at less cost than one by one. `textures` is scratch.
  void fill(Eigen::Index first, std::vector<Look>& looks, Eigen::MatrixXf& textures) const;

  /// The face's points that follow the eyes' parameters, 1 or 0 each.
  const Eigen::VectorXd& eye_points() const { return eye_points_; }
  /// Raster, 32-bit: how far the texture is that of the eyes' parameters, and that of real mouths.
  const cv::Mat& eye_share() const { return eye_share_; }
  const cv::Mat& mouth_share() const { return mouth_.share; }
  void hash(Archive& ar) const;

 private:
  void prepare_eyes();
  void prepare_mouths();
  void put_eyes(Look& look, Eigen::Index t) const;
  void put_mouth(Look& look, Eigen::Index t) const;

  AppearanceModel model_;
  Track parameters_;
  Eyes eyes_;          ///< without points: none
  MouthTrack mouths_;  ///< nothing chosen: none
  MouthRegion mouth_;
  Eigen::MatrixXf mouth_modes_;  ///< texture of its pixels per unit of c
  cv::Mat eye_share_;
  Eigen::VectorXd eye_points_;
};

/// A shape with the points that `which` marks (1, else 0) of another one, which is laid upon them first.
Shape with_points(const Shape& shape, const Shape& other, const Eigen::VectorXd& which);

/// Reads looks in order, in blocks.
class LookReader {
 public:
  explicit LookReader(std::shared_ptr<const Looks> looks) : looks_(std::move(looks)) {}
  /// Null at the end; valid until the next call.
  const Look* next();

 private:
  std::shared_ptr<const Looks> looks_;
  std::vector<Look> block_;
  Eigen::MatrixXf textures_;
  Eigen::Index first_ = 0, at_ = 0;
};

}  // namespace talkgraph
