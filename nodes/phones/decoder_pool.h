#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace talkgraph {

/// Decoders take a moment to load and serve one thread at a time: those not in
/// use wait here. There are as many as were ever in use together.
template <class Decoder>
class DecoderPool {
 public:
  using Lease = std::unique_ptr<Decoder, std::function<void(Decoder*)>>;

  /// A decoder that returns here when the lease ends.
  Lease take() {
    std::unique_ptr<Decoder> decoder;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        decoder = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (!decoder) decoder = std::make_unique<Decoder>();
    return Lease(decoder.release(), [this](Decoder* d) { give_back(std::unique_ptr<Decoder>(d)); });
  }

 private:
  void give_back(std::unique_ptr<Decoder> decoder) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(decoder));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<Decoder>> idle_;
};

/// The pool of a kind of decoder in this process.
template <class Decoder>
DecoderPool<Decoder>& decoder_pool() {
  static DecoderPool<Decoder> pool;
  return pool;
}

}  // namespace talkgraph
