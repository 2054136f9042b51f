#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "graph/value.h"

namespace talkgraph {

/// Training frames as plain regression sees them: z-scored audio with ±n
/// neighbours, and what it has to predict.
struct StackedInputs {
  int context = 5;           ///< frames on each side
  Eigen::RowVectorXd mean;   ///< of the audio dimensions
  Eigen::RowVectorXd scale;  ///< 1 / standard deviation; 0 for a constant dimension
};
void fields(Archive& ar, StackedInputs& s);

/// The training mean.
struct MeanModel {
  Eigen::RowVectorXd mean;
};
template <>
inline constexpr PortType port_type<MeanModel>{"MeanModel", 1};
void fields(Archive& ar, MeanModel& m);

/// Ridge regression from stacked audio to visual parameters.
struct RidgeModel {
  StackedInputs inputs;
  Eigen::MatrixXd weights;    ///< stacked audio × visual
  Eigen::RowVectorXd offset;  ///< visual
};
template <>
inline constexpr PortType port_type<RidgeModel>{"RidgeModel", 1};
void fields(Archive& ar, RidgeModel& m);

/// All training frames, to look neighbours up in.
struct NeighboursModel {
  StackedInputs inputs;
  Eigen::RowVectorXd weights;  ///< of the columns of stacked audio
  Eigen::MatrixXd audio;       ///< N × stacked audio, z-scored and weighted
  Eigen::MatrixXd visual;      ///< N × visual
};
template <>
inline constexpr PortType port_type<NeighboursModel>{"NeighboursModel", 2};
void fields(Archive& ar, NeighboursModel& m);

/// The mean trajectory of each state's training windows.
struct TrajectoriesModel {
  std::map<std::string, Eigen::MatrixXd> trajectories;  ///< by the state's label, T × visual
  std::map<std::string, std::string> ending;            ///< phone -> the state with most frames that ends in it
  Eigen::RowVectorXd mean;                              ///< of all windows' frames
};
template <>
inline constexpr PortType port_type<TrajectoriesModel>{"TrajectoriesModel", 1};
void fields(Archive& ar, TrajectoriesModel& m);

}  // namespace talkgraph
