#include "nodes/types/codec.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace talkgraph {
namespace {

void* open_codecs() {
  // Found by the run path of the program.
  void* library = dlopen("libtalkgraph_codecs.so", RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw std::runtime_error(fmt::format(
        "the library that reads and writes pictures and clips cannot be loaded: {}; is it beside the program, "
        "or in lib/talkgraph of the installation?",
        dlerror()));
  return library;
}

}  // namespace

void* find_codec(const char* name) {
  // Never closed: what it made may live anywhere.
  static void* const library = open_codecs();
  void* function = dlsym(library, name);
  if (!function) throw std::runtime_error(fmt::format("libtalkgraph_codecs.so has no {}: build it again", name));
  return function;
}

}  // namespace talkgraph
