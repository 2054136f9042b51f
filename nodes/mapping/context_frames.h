#pragma once

#include <string>
#include <vector>

#include "nodes/types/context_gp.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// How much of each frame each of these phones takes (T × phones): 0 to 1.
Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like);

/// Where in its recording each frame is, T × 2: exp(−t / time) for t seconds since the recording begins, and for t
/// seconds until speech ends, 1 thereafter. Where nobody speaks it ends with the sound.
Eigen::MatrixXd places(const PhoneTrack& phones, const Track& like, double time);

/// What the kernel compares of the first `frames` frames, a row a frame: f of ContextGp.
Eigen::MatrixXd context_frames(const ContextGp& model, const Track& audio, const PhoneTrack& phones,
                               Eigen::Index frames);

}  // namespace talkgraph
