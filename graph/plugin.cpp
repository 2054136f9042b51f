#include "graph/plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace talkgraph {

void load_plugin(const std::filesystem::path& file, Registry& registry) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("plugin {}: {}", file.string(), why));
  };
  if (!std::filesystem::exists(file)) refuse("there is no such file");
  // An absolute path: for a bare name dlopen would look in the system's folders.
  void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    refuse(fmt::format("cannot be loaded: {}; it must be a shared library built against this talkgraph", dlerror()));
  // Never closed: values and functors of its types live anywhere in the program.
  const auto entry = reinterpret_cast<Plugin (*)()>(dlsym(library, "talkgraph_plugin"));
  if (!entry) refuse("is no talkgraph plugin: one source file of it needs TALKGRAPH_PLUGIN(function) (graph/plugin.h)");
  const Plugin plugin = entry();
  if (std::string_view(plugin.version) != TALKGRAPH_PLUGIN_VERSION)
    refuse(fmt::format("was built for\n  {}\nbut this program is\n  {}\nbuild the plugin again", plugin.version,
                       TALKGRAPH_PLUGIN_VERSION));
  try {
    plugin.add(registry);
  } catch (const std::exception& e) {
    refuse(fmt::format("its nodes cannot be registered: {}", e.what()));
  } catch (...) {
    refuse("its nodes cannot be registered: something other than a std::exception was thrown");
  }
}

}  // namespace talkgraph
