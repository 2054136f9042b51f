#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "graph/value.h"
#include "nodes/types/phones.h"
#include "nodes/types/segments.h"
#include "nodes/types/sgpdm.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// What pictures show of a trained model; it refers to the model, which outlives it.
struct LatentSpace {
  struct Process {
    std::string name;  ///< "audio", "visual", "observations", "dynamics"
    const GaussianProcess* process;
  };
  std::string label;                  ///< of the state; empty for one without
  const Eigen::MatrixXd* latents;     ///< N × d
  std::vector<std::int64_t> lengths;  ///< of the windows; they sum to N
  std::vector<Process> observed;      ///< those of data
  std::optional<Process> dynamics;
  const std::vector<double>* trace;  ///< ln p at the start and after each iteration
  std::string ended;                 ///< why training stopped
};

/// Of each state of an Ssgpdm in the order of labels; one of an Sgpdm or a Gpdm. Throws std::runtime_error on a model
/// of another type or without states, points or dimensions.
std::vector<LatentSpace> latent_spaces(const Value& model);
/// That of the state with this label; if it is empty, of the one with most frames among those of several phones, or
/// else among all. Throws std::invalid_argument, which
/// names the nearest label, if there is no such state.
LatentSpace latent_space(const Value& model, const std::string& state);

/// "k-ae-t: 159 frames in 53 windows".
std::string heading_of(const LatentSpace& space);

/// By name; the last one observed if that is empty. Throws std::invalid_argument that says which there are.
LatentSpace::Process process_of(const LatentSpace& space, const std::string& name);

/// How much each latent dimension does, d: the variance of its points times its inverse width, in all kernels of the
/// observed processes. With one width for all dimensions that orders them by variance.
Eigen::VectorXd relevances(const LatentSpace& space);

/// A direction of a picture: a latent dimension; or, where there are too few, the frame's number in its window, or 0.
struct LatentAxis {
  enum class Kind { dimension, frame, nothing } kind;
  Eigen::Index dimension = 0;
  std::string name() const;
};
/// `count` axes along the chosen dimensions, counted from 1; the most relevant if none are chosen. Throws
/// std::invalid_argument unless they are `count` different dimensions of the space.
std::vector<LatentAxis> latent_axes(const LatentSpace& space, const std::vector<int>& chosen, std::size_t count);
/// Points along axes, T × axes. `frames` are the numbers of the points in their windows.
Eigen::MatrixXd along(const std::vector<LatentAxis>& axes, const Eigen::MatrixXd& points,
                      const std::vector<std::int64_t>& frames);
/// Of every latent point its number in its window, from 0.
std::vector<std::int64_t> frames_in_windows(const std::vector<std::int64_t>& lengths);

/// The reverse, T × d: latent points at places along axes; other dimensions are at the mean of the space's points.
Eigen::MatrixXd latents_at(const LatentSpace& space, const std::vector<LatentAxis>& axes,
                           const Eigen::MatrixXd& places);

/// ln 1/σ²(x) at latent points, in scaled units: how sure the process' prediction is.
Eigen::VectorXd log_precision(const GaussianProcess& process, const Eigen::MatrixXd& x);

/// What is said at every latent point: that of `labels`, a sequence a window, or all windows' frames one after another;
/// without them, the state's phones where a window has as many frames ("k-ae-t"), else its label. Throws
/// std::runtime_error if labels do not fit the model's windows.
std::vector<std::string> latent_phones(const LatentSpace& space, const Collected<FrameLabels>& labels);

/// Parts of synthesised latent paths that a space speaks for: those whose segment has its label, whole ones where
/// no segments are given or the space has no label; each T × d. Throws std::runtime_error if a path is narrower than
/// the space or its segments do not fit it.
std::vector<Eigen::MatrixXd> paths_within(const LatentSpace& space, const Collected<Track>& paths,
                                          const Collected<SegmentTrack>& segments);

/// Colours for what is said, most frequent first; from the twelfth on one grey serves all.
struct PhoneColours {
  std::vector<std::string> names;     ///< the last is "n others" where there are more than twelve
  std::vector<std::string> colours;   ///< of each name, "#rrggbb"
  std::vector<std::int64_t> counts;   ///< frames of each name
  std::vector<std::size_t> of_frame;  ///< index of the name, of each frame
};
PhoneColours phone_colours(const std::vector<std::string>& phones);

}  // namespace talkgraph
