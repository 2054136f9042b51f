#pragma once

#include <filesystem>

#include "study/study.h"

namespace talkgraph::study {

/// A study of three tests: two clips of each category are shown, 16 in all, of 24; the questions are 2 of the person,
/// 1, 3 and 1 of a clip.
Study small_study();

/// That study in a folder; its clips hold no pictures, but "bytes of ID.webm".
void write_small_study(const std::filesystem::path& folder);

}  // namespace talkgraph::study
