#pragma once

namespace talkgraph {

/// A function of libtalkgraph_codecs.so (nodes/codecs/codecs.h), which is loaded when the first is asked for:
///   codec<decltype(codec_read_picture)>("codec_read_picture")(file, pixels);
/// Throws std::runtime_error if the library is not to be found or lacks the function.
void* find_codec(const char* name);

template <class Function>
Function* codec(const char* name) {
  return reinterpret_cast<Function*>(find_codec(name));
}

}  // namespace talkgraph
