#pragma once

#include <Eigen/Core>
#include <optional>

#include "graph/context.h"
#include "graph/description.h"
#include "nodes/types/canonical.h"
#include "nodes/types/ppca.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// The likeliest PPCA, in closed form. Directions without variance have zero loadings, so d may exceed the rank of Y.
Ppca fit_ppca(const Eigen::MatrixXd& y, Eigen::Index d);

/// By singular values of orthonormal bases of both streams (Björck and Golub 1973): fewer frames than dimensions and
/// constant columns are answered within the space in which the data vary. N × D_Y and N × D_Z; N ≥ 1.
Cca fit_cca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d);

/// In closed form. Each covariance Σ is taken as (1 − ρ)Σ + ρ·mean variance·I with
/// ρ = D / (D + N) · `shrinkage`: exact for many frames, and finite for fewer
/// frames than dimensions or constant columns. Dimensions beyond the smaller
/// stream's have correlation and loadings zero. N × D_Y and N × D_Z; N ≥ 1.
Pcca fit_pcca(const Eigen::MatrixXd& y, const Eigen::MatrixXd& z, Eigen::Index d, double shrinkage = 1);

/// Canonical correlations of the frames that both streams of a sequence have. Throws std::runtime_error, naming the
/// sequence, if there is no such frame, on different dimensions, on lengths that differ by more than two frames and on
/// values that are not finite.
struct TrainCca {
  int latent_dimension = 2;

  Cca operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainCca>& d);

enum class CanonicalStream { audio, visual };
template <>
inline constexpr EnumNames<CanonicalStream, 2> enum_names<CanonicalStream>{
    {{CanonicalStream::audio, "audio"}, {CanonicalStream::visual, "visual"}}};

/// A track of one stream along that stream's canonical directions, T × d; lost frames stay marked.
struct ProjectCca {
  CanonicalStream stream = CanonicalStream::audio;

  Track operator()(const Cca& model, const Track& track) const;
};
void describe(Description<ProjectCca>& d);

/// As TrainCca, with a density.
struct TrainPcca {
  int latent_dimension = 2;
  double shrinkage = 1;

  Pcca operator()(const Collected<Track>& audio, const Collected<Track>& visual, Context& context) const;
};
void describe(Description<TrainPcca>& d);

/// Posterior means of latent points given one stream or both, T × d. In a frame that one stream has lost the other
/// speaks alone; one that all have lost has the prior's mean, and is marked. No stream gives nothing. Throws
/// std::runtime_error on other dimensions than the model's, on values that are not finite and on lengths that differ by
/// more than two frames.
struct ProjectPcca {
  std::optional<Track> operator()(const Pcca& model, const Track* audio, const Track* visual) const;
};
void describe(Description<ProjectPcca>& d);

/// Probabilistic principal components of the measured frames of all tracks. Throws std::runtime_error, naming the
/// track, if none has a measured frame, on different dimensions and on values that are not finite.
struct TrainPpca {
  int latent_dimension = 2;

  Ppca operator()(const Collected<Track>& tracks, Context& context) const;
};
void describe(Description<TrainPpca>& d);

/// Posterior means of a track's latent points, T × d; lost frames stay marked.
struct ProjectPpca {
  Track operator()(const Ppca& model, const Track& track) const;
};
void describe(Description<ProjectPpca>& d);

}  // namespace talkgraph
