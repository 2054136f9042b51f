#include "annotate/frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "graph/random.h"

namespace talkgraph::annotate {
namespace {

/// Gathers frames that are there, sound and new.
class Choice {
 public:
  Choice(const std::vector<Clip>& clips, std::size_t count) : clips_(clips), count_(count) {}

  bool full() const { return frames_.size() == count_; }
  std::vector<Frame> take() { return std::move(frames_); }

  void add_at(std::size_t clip, double seconds, const std::string& phone) {
    const double rate = video(clip).source->rate().value();
    add({clip, static_cast<std::int64_t>(std::floor(seconds * rate)), phone});
  }
  /// `share` of the clip's length, 0 to 1.
  void add_share(std::size_t clip, double share) {
    add({clip, static_cast<std::int64_t>(share * static_cast<double>(video(clip).source->frames())), ""});
  }

 private:
  const Video& video(std::size_t clip) {
    auto& opened = opened_[clip];
    if (!opened.source) opened = clips_[clip].video();
    return opened;
  }

  void add(Frame frame) {
    const auto& source = *video(frame.clip).source;
    if (frame.number < 0 || frame.number >= source.frames()) return;
    const auto broken = source.decoding_errors();
    if (std::find(broken.begin(), broken.end(), frame.number) != broken.end()) return;
    if (seen_.emplace(frame.clip, frame.number).second) frames_.push_back(std::move(frame));
  }

  const std::vector<Clip>& clips_;
  const std::size_t count_;
  std::map<std::size_t, Video> opened_;
  std::set<std::pair<std::size_t, std::int64_t>> seen_;
  std::vector<Frame> frames_;
};

struct Moment {
  std::size_t clip;
  double seconds;
};
struct Phone {
  std::string label;
  std::vector<Moment> moments;
};

/// The phones, most frequent first, each with the middles of all that were spoken in a drawn order.
std::vector<Phone> spoken_phones(const std::vector<Clip>& clips, std::uint64_t seed) {
  std::map<std::string, std::vector<Moment>> moments;
  for (std::size_t c = 0; c < clips.size(); ++c)
    if (clips[c].phones)
      for (const auto& phone : clips[c].phones->phones)
        moments[phone.label].push_back({c, (phone.start + phone.end) / 2});
  std::vector<Phone> phones;
  for (auto& [label, all] : moments) {
    Random(seed, "annotate", label).shuffle(all);
    phones.push_back({label, std::move(all)});
  }
  std::stable_sort(phones.begin(), phones.end(),
                   [](const Phone& a, const Phone& b) { return a.moments.size() > b.moments.size(); });
  return phones;
}

void choose_by_phone(const std::vector<Phone>& phones, Choice& choice) {
  for (std::size_t round = 0; round < phones.front().moments.size(); ++round)
    for (const auto& [label, moments] : phones) {
      if (choice.full()) return;
      if (round < moments.size()) choice.add_at(moments[round].clip, moments[round].seconds, label);
    }
}

/// Multiples of the golden ratio, modulo 1: any number of them lies evenly.
void choose_by_time(std::size_t clips, int count, std::uint64_t seed, Choice& choice) {
  const double first = Random(seed, "annotate", "").uniform();
  for (int i = 0; i < 50 * count && !choice.full(); ++i) {
    double whole = 0;
    const double place = std::modf(first + i * 0.6180339887498949, &whole) * static_cast<double>(clips);
    const auto clip = std::min(clips - 1, static_cast<std::size_t>(place));
    choice.add_share(clip, place - static_cast<double>(clip));
  }
}

}  // namespace

std::vector<Frame> choose_frames(const std::vector<Clip>& clips, int count, std::uint64_t seed) {
  Choice choice(clips, static_cast<std::size_t>(count));
  if (clips.empty() || count <= 0) return {};
  const auto phones = spoken_phones(clips, seed);
  if (phones.empty())
    choose_by_time(clips.size(), count, seed, choice);
  else
    choose_by_phone(phones, choice);
  return choice.take();
}

}  // namespace talkgraph::annotate
