#include "nodes/latent/checkpoint.h"

#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {

Checkpoint::Checkpoint(const std::string& folder, const std::function<Key()>& of, std::function<void(Archive&)> fields)
    : fields_(std::move(fields)) {
  if (folder.empty()) return;
  std::filesystem::create_directories(folder);
  path_ = std::filesystem::path(folder) / (of().str() + ".h5");
}

bool Checkpoint::load(const std::string& subject, const Context& context) {
  if (path_.empty() || !std::filesystem::exists(path_)) return false;
  try {
    fields_(*hdf5_reader(path_.string()));
    return true;
  } catch (const std::runtime_error& e) {
    context.warn(
        fmt::format("{}: the checkpoint cannot be read ({}): it is removed, training begins anew", subject, e.what()));
    remove();
    return false;
  }
}

void Checkpoint::between_steps(const Context& context) {
  if (context.cancelled() || std::chrono::steady_clock::now() - saved_ >= std::chrono::seconds(10)) save();
  context.check_cancelled();
}

void Checkpoint::save() {
  if (!path_.empty()) write_hdf5(path_.string(), fields_);
  saved_ = std::chrono::steady_clock::now();
}

void Checkpoint::remove() {
  if (!path_.empty()) std::filesystem::remove(path_);
}

}  // namespace talkgraph
