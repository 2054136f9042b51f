#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "graph/value.h"
#include "nodes/types/video.h"

namespace talkgraph {

/// Mouths of real frames, each warped as the textures of an appearance model are
/// and brought to the model's average light. There may be none.
struct Mouths {
  std::vector<int> points;      ///< landmarks around the mouth
  double margin = 0;            ///< that a mouth reaches beyond them, share of the mouth's width
  Eigen::MatrixXd parameters;   ///< N × modes: appearance parameters c of the frames
  std::vector<Image> pictures;  ///< N, all of one size: the mouth's box on the model's finest raster

  Eigen::Index size() const { return parameters.rows(); }
};
template <>
inline constexpr PortType port_type<Mouths>{"Mouths", 1};
void fields(Archive& ar, Mouths& m);

/// A real mouth for every frame of a clip.
struct MouthTrack {
  Mouths mouths;
  std::vector<std::int64_t> chosen;  ///< rows of `mouths`, one a frame; empty where there are no mouths
};
template <>
inline constexpr PortType port_type<MouthTrack>{"MouthTrack", 1};
void fields(Archive& ar, MouthTrack& m);

}  // namespace talkgraph
