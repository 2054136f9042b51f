#pragma once

#include <string>
#include <vector>

#include "nodes/types/context_gp.h"
#include "nodes/types/phones.h"
#include "nodes/types/track.h"

namespace talkgraph {

/// How much of each frame each of these phones takes (T × phones): 0 to 1.
Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like);

/// Seconds at which the last phone that is no pause ends; where nobody speaks, the time of a frame after the last.
double end_of_speech(const PhoneTrack& phones, const Track& like);

/// What the kernel compares of the first `frames` frames, a row a frame: f of ContextGp.
Eigen::MatrixXd context_frames(const ContextGp& model, const Track& audio, const PhoneTrack& phones,
                               Eigen::Index frames);

}  // namespace talkgraph
