#include "nodes/corpus/landmarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "graph/archive.h"
#include "nodes/corpus/tables.h"
#include "nodes/corpus/text.h"
#include "nodes/media/video_file.h"
#include "nodes/types/scheme.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string ending_of(const fs::path& path) { return lower_case(path.extension().string()); }

/// x0, y0, x1, y1, ...
Shape shape_of(const Eigen::VectorXd& numbers) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(numbers.data(), numbers.size() / 2,
                                                                                     2);
}
Shape shape_of(const std::vector<double>& numbers) {
  return shape_of(Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers)).eval());
}

int count_in(const std::string& word, const std::string& path, int line) {
  const double count = number_in(word, path, line);
  if (count < 1 || count > 10000 || count != std::floor(count))
    complain(path, line, fmt::format("a number of points is expected, got \"{}\"", word));
  return static_cast<int>(count);
}

void check_count(const Shape& shape, int promised, const std::string& path, int line) {
  if (shape.rows() != promised)
    complain(path, line, fmt::format("{} points are promised here, {} are there", promised, shape.rows()));
}

/// The .pts and .asf files of a folder by name; all of one kind.
std::vector<std::string> point_files(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (const auto ending = ending_of(entry.path()); ending == ".pts" || ending == ".asf")
      files.push_back(entry.path().string());
  if (files.empty()) throw std::runtime_error(folder + ": there is no .pts or .asf file in this folder");
  std::sort(files.begin(), files.end(), natural_less);
  for (const auto& file : files)
    if (ending_of(file) != ending_of(files[0]))
      throw std::runtime_error(folder + ": holds .pts and .asf files; landmarks are either");
  return files;
}

/// "s001_012.pts" -> 12.
std::int64_t last_number(const fs::path& file) {
  constexpr auto digits = "0123456789";
  const std::string stem = file.stem().string();
  const auto end = stem.find_last_of(digits);
  const auto begin = end == std::string::npos ? 0 : stem.find_last_not_of(digits, end) + 1;
  if (end == std::string::npos || end - begin >= 12)
    throw std::runtime_error(file.string() + ": its name does not end in the number of its frame, as 000012.pts does");
  return std::stoll(stem.substr(begin, end + 1 - begin));
}

/// That no frame is left out, since the files after it would count for the frames before theirs. They are numbered from
/// 0, or from wherever a clip of as many frames begins; from 1 where there is no clip to tell.
void check_consecutive(const std::vector<std::string>& files, const LandmarkFiles& from,
                       const std::function<Video()>& video) {
  constexpr auto advice =
      "if only some frames have landmarks, name their files after them, counted from 0 as 000012.pts, and say "
      "\"sparse\": true in the manifest";
  const auto first = last_number(files.front());
  std::vector<std::int64_t> missing;
  for (std::size_t i = 1; i < files.size(); ++i) {
    const auto before = last_number(files[i - 1]), now = last_number(files[i]);
    if (now <= before)
      throw std::runtime_error(fmt::format("{}: frame {} is expected after \"{}\"", files[i], before + 1,
                                           fs::path(files[i - 1]).filename().string()));
    for (auto t = before + 1; t < now && missing.size() < 10; ++t) missing.push_back(t);
  }
  if (!missing.empty())
    throw std::runtime_error(fmt::format("{}: there is no file of {} {}{}; {}", from.path,
                                         missing.size() == 1 ? "frame" : "the frames", fmt::join(missing, ", "),
                                         missing.size() == 10 ? ", ..." : "", advice));
  const auto count = std::ssize(files);
  if (first == 0 || (first == 1 && !video)) return;
  const auto length = video ? video().source->frames() : 0;
  if (length != count)
    throw std::runtime_error(fmt::format("{}: has files of the frames {} to {}{}: which is the first?; {}", from.path,
                                         first, first + count - 1,
                                         video ? fmt::format(", and the clip {} frames", length) : "", advice));
}

/// Frames by number.
using Frames = std::map<std::int64_t, Shape>;

void check_alike(const Frames& frames, const Shape& next, const std::string& file) {
  if (!frames.empty() && frames.begin()->second.rows() != next.rows())
    throw std::runtime_error(fmt::format("{}: holds {} points, the first file of the folder {}", file, next.rows(),
                                         frames.begin()->second.rows()));
}

Frames read_folder(const LandmarkFiles& from, const std::function<Video()>& video) {
  Frames frames;
  std::optional<cv::Size> size;
  const auto files = point_files(from.path);
  if (!from.sparse) check_consecutive(files, from, video);
  for (const auto& file : files) {
    const auto number = from.sparse ? frame_in_name(file) : std::optional(std::ssize(frames));
    if (!number) continue;
    const bool relative = ending_of(file) == ".asf";
    if (relative && !size) {
      if (!video)
        throw std::runtime_error(file + ": .asf has shares of a picture's size, and this clip has no picture");
      size = video().source->size();
    }
    auto shape = relative ? read_asf(file, *size) : read_pts(file);
    check_alike(frames, shape, file);
    if (!frames.emplace(*number, std::move(shape)).second)
      throw std::runtime_error(fmt::format("{}: there is another file of frame {}", file, *number));
  }
  if (frames.empty())
    throw std::runtime_error(from.path + ": no file in this folder is named after its frame, as 000012.pts is");
  return frames;
}

struct PointColumns {
  std::optional<Eigen::Index> frame;
  std::vector<Eigen::Index> points;  ///< of x0, y0, x1, y1, ...
};

/// By their names, in whatever order they are; without names in the order of points.
PointColumns columns_of(const NumberTable& table, const std::string& path) {
  constexpr auto needed = "landmarks need the columns x0,y0,x1,y1,... and maybe \"frame\" before them";
  PointColumns out;
  if (table.names.empty()) {
    if (table.values.cols() % 2) throw std::runtime_error(fmt::format("{}: {}", path, needed));
    out.points.resize(static_cast<std::size_t>(table.values.cols()));
    std::iota(out.points.begin(), out.points.end(), Eigen::Index{0});
    return out;
  }
  std::map<std::string, Eigen::Index> left;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto words = words_of(lower_case(table.names[i]));
    const auto name = fmt::format("{}", fmt::join(words, " "));
    if (!left.emplace(name, i).second) throw std::runtime_error(fmt::format("{}: has two columns \"{}\"", path, name));
  }
  if (const auto frame = left.extract("frame")) out.frame = frame.mapped();
  do {
    for (const char axis : {'x', 'y'}) {
      const auto name = fmt::format("{}{}", axis, out.points.size() / 2);
      const auto column = left.extract(name);
      if (!column)
        throw std::runtime_error(fmt::format("{}: {}; it has no \"{}\"{}", path, needed, name,
                                             left.empty() ? "" : ", but \"" + left.begin()->first + "\""));
      out.points.push_back(column.mapped());
    }
  } while (!left.empty());
  return out;
}

Frames read_csv_landmarks(const LandmarkFiles& from) {
  const NumberTable table = read_csv(from.path);
  const auto columns = columns_of(table, from.path);
  if (from.sparse && !columns.frame)
    throw std::runtime_error(from.path + ": landmarks of some frames need a first column \"frame\"");
  Frames frames;
  for (Eigen::Index t = 0; t < table.values.rows(); ++t) {
    const double frame = columns.frame ? table.values(t, *columns.frame) : static_cast<double>(t);
    const int line = table.lines[static_cast<std::size_t>(t)];
    if (!from.sparse && frame != static_cast<double>(t))
      complain(from.path, line, fmt::format("frame {} is expected, got {}", t, frame));
    if (!(frame >= 0 && frame < 1e12 && frame == std::floor(frame)))
      complain(from.path, line, fmt::format("{} is no number of a frame", frame));
    const Eigen::VectorXd points = table.values(t, columns.points);
    if (!frames.emplace(static_cast<std::int64_t>(frame), shape_of(points)).second)
      complain(from.path, line, fmt::format("frame {} stands here again", frame));
  }
  return frames;
}

Frames read_hdf5_landmarks(const LandmarkFiles& from) {
  if (from.sparse)
    throw std::runtime_error(from.path + ": frames without landmarks are nan in HDF5; leave out \"sparse\"");
  const auto reader = hdf5_reader(from.path);
  const auto wrong = [&](Eigen::Index columns) {
    throw std::runtime_error(
        fmt::format("{}: {}: landmarks are frames x points x 2 or frames x 2 points, not of {} columns", from.path,
                    from.dataset, columns));
  };
  Frames frames;
  const auto add = [&](Shape shape) { frames.emplace_hint(frames.end(), std::ssize(frames), std::move(shape)); };
  std::vector<Eigen::MatrixXd> shapes;
  try {
    (*reader)(from.dataset, shapes);
  } catch (const std::runtime_error&) {  // not of three dimensions
    Eigen::MatrixXd rows;
    (*reader)(from.dataset, rows);
    if (rows.cols() < 2 || rows.cols() % 2) wrong(rows.cols());
    for (const auto& row : rows.rowwise()) add(shape_of(Eigen::VectorXd(row.transpose())));
  }
  for (const auto& shape : shapes) {
    if (shape.cols() != 2 || shape.rows() != shapes[0].rows()) wrong(shape.cols());
    add(shape);
  }
  if (frames.empty()) throw std::runtime_error(fmt::format("{}: {}: holds no landmarks", from.path, from.dataset));
  return frames;
}

/// One shape a frame of a clip that has `length`; what is not there is nan.
std::vector<Shape> filled(Frames frames, std::int64_t length, const std::string& path) {
  if (frames.rbegin()->first >= length)
    throw std::runtime_error(fmt::format("{}: has landmarks of frame {}; the clip has the frames 0 to {}", path,
                                         frames.rbegin()->first, length - 1));
  std::vector<Shape> shapes(static_cast<std::size_t>(length), Shape::Constant(frames.begin()->second.rows(), 2, nan));
  for (auto& [t, shape] : frames) shapes[static_cast<std::size_t>(t)] = std::move(shape);
  return shapes;
}

}  // namespace

std::optional<std::int64_t> frame_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const bool digits = stem.size() < 12 && stem.find_first_not_of("0123456789") == std::string::npos;
  return digits && !stem.empty() ? std::optional(std::stoll(stem)) : std::nullopt;
}

Shape read_pts(const std::string& path) {
  std::vector<double> numbers;
  bool inside = false;
  int promised = 0, promised_in = 0, last = 1;
  for (const auto& line : lines_of(read_text_file(path))) {
    last = line.number;
    const auto words = words_of(line.text);
    if (words[0] == "{" || words[0] == "}") {
      inside = words[0] == "{";
    } else if (inside) {
      if (words.size() != 2) complain(path, line.number, "\"x y\" is expected");
      for (const auto& word : words) numbers.push_back(number_in(word, path, line.number) - 1);
    } else if (words[0] == "n_points:") {
      promised = count_in(words.size() == 2 ? words[1] : "", path, promised_in = line.number);
    }
  }
  if (inside) complain(path, last, "breaks off before the \"}\"");
  if (numbers.empty()) throw std::runtime_error(path + ": holds no points");
  Shape shape = shape_of(numbers);
  if (promised) check_count(shape, promised, path, promised_in);
  return shape;
}

Shape read_asf(const std::string& path, cv::Size size) {
  Shape shape;
  int read = 0, promised_in = 0;
  for (const auto& line : lines_of(read_text_file(path))) {
    const auto words = words_of(line.text);
    if (words[0].starts_with('#')) continue;
    if (!promised_in) {
      shape = Shape::Constant(count_in(words[0], path, promised_in = line.number), 2, nan);
    } else if (read < shape.rows()) {
      if (words.size() != 7) complain(path, line.number, "\"path type x y point from to\" is expected");
      const double point = number_in(words[4], path, line.number);
      if (!(point >= 0 && point < static_cast<double>(shape.rows()) && point == std::floor(point)))
        complain(path, line.number,
                 fmt::format("a point is expected, 0 to {}, got \"{}\"", shape.rows() - 1, words[4]));
      auto row = shape.row(static_cast<Eigen::Index>(point));
      if (!std::isnan(row.x())) complain(path, line.number, fmt::format("point {} stands here again", point));
      const double x = number_in(words[2], path, line.number), y = number_in(words[3], path, line.number);
      row << x * size.width, y * size.height;
      ++read;
    }  // then the name of the picture
  }
  if (!promised_in) throw std::runtime_error(path + ": holds no points");
  check_count(shape.topRows(read), static_cast<int>(shape.rows()), path, promised_in);
  return shape;
}

LandmarkTrack read_landmarks(const LandmarkFiles& files, Rational rate, const std::function<Video()>& video) {
  const bool folder = fs::is_directory(files.path), csv = ending_of(files.path) == ".csv";
  auto frames = folder ? read_folder(files, video) : csv ? read_csv_landmarks(files) : read_hdf5_landmarks(files);
  const auto points = frames.begin()->second.rows();
  LandmarkTrack track{{}, rate, files.scheme.empty() && points == 68 ? "ibug68" : files.scheme};
  if (const auto scheme = find_scheme(track.scheme); scheme && scheme->points() != points)
    throw std::runtime_error(fmt::format("{}: holds {} points, the scheme \"{}\" has {}", files.path, points,
                                         scheme->name, scheme->points()));
  if (files.sparse && !video)
    throw std::runtime_error(files.path + ": landmarks of some frames need the clip's \"video\"");
  const auto length = files.sparse ? video().source->frames() : std::ssize(frames);
  track.frames = filled(std::move(frames), length, files.path);
  return track;
}

}  // namespace talkgraph
