#include "nodes/mapping/context_frames.h"

#include <algorithm>
#include <cmath>

#include "nodes/speech/place.h"
#include "nodes/types/visemes.h"

namespace talkgraph {

Eigen::MatrixXd phone_shares(const PhoneTrack& phones, const std::vector<std::string>& inventory, const Track& like) {
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(like.frames(), static_cast<Eigen::Index>(inventory.size()));
  const double rate = like.rate.value();
  for (const auto& phone : phones.phones) {
    const auto at = std::find(inventory.begin(), inventory.end(), phone.label);
    if (at == inventory.end()) continue;
    const double from = (phone.start - like.start) * rate + 0.5, to = (phone.end - like.start) * rate + 0.5;
    const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::floor(from)));
    for (Eigen::Index t = first; t < like.frames() && static_cast<double>(t) < to; ++t)
      shares(t, at - inventory.begin()) +=
          std::max(0.0, std::min(to, static_cast<double>(t + 1)) - std::max(from, static_cast<double>(t)));
  }
  return shares;
}

double end_of_speech(const PhoneTrack& phones, const Track& like) {
  const auto ends = std::ranges::find_if(phones.phones.rbegin(), phones.phones.rend(),
                                         [](const auto& phone) { return !is_pause(phone.label); });
  return ends != phones.phones.rend() ? ends->end : like.time(like.frames());
}

Eigen::MatrixXd context_frames(const ContextGp& model, const Track& audio, const PhoneTrack& phones,
                               Eigen::Index frames) {
  const Eigen::Index heard = model.audio_mean.size(), said = std::ssize(model.phones);
  Eigen::MatrixXd f(frames, model.map.rows());
  f.leftCols(heard) =
      (audio.values.topRows(frames).rowwise() - model.audio_mean).array().rowwise() * model.audio_scale.array();
  f.middleCols(heard, said) = phone_shares(phones, model.phones, audio).topRows(frames);
  if (model.place_time > 0)
    f.rightCols(2) = places(audio, end_of_speech(phones, audio), model.place_time).topRows(frames);
  return f * model.map;
}

}  // namespace talkgraph
