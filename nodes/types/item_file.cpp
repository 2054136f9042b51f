#include "nodes/types/item_file.h"

namespace talkgraph {

Artifact item_file(const Context& context, const std::string& folder, const std::string& ending,
                   const std::string& otherwise, const std::string& prefix, const std::string& suffix) {
  const std::string item = context.item.empty() && prefix.empty() && suffix.empty() ? otherwise : context.item;
  const std::string stem = prefix + item + suffix;
  return {(std::filesystem::path(folder) / (stem + ending)).generic_string(), stem};
}

}  // namespace talkgraph
