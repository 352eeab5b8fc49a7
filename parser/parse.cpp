#include "parser/parse.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "parser/include.h"
#include "parser/instance_names.h"
#include "parser/lexer.h"
#include "parser/reporter.h"
#include "parser/scene_builder.h"
#include "parser/statements.h"

namespace whit {

namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& folder) {
  std::error_code failed;
  const fs::path path = fs::absolute(folder.empty() ? "." : folder, failed);
  return failed ? folder : path.lexically_normal().string();
}

/// Reads the main file and what it includes, in order. The files being read are a stack of its own, so that
/// the depth of inclusion is not limited by the program's.
class FileReader {
 public:
  FileReader(Sources& sources, Reporter& reporter, std::string folder, const ParseOptions& options)
      : sources_(sources),
        reporter_(reporter),
        folder_(std::move(folder)),
        options_(options),
        inclusion_(sources, reporter, folder_) {}

  uint64_t read(uint32_t main_file, SceneBuilder& builder) {
    push(main_file);
    open_.back().is_model = options_.is_model;
    while (!open_.empty()) {
      const ReadResult result = read_statement(open_.back().lexer, statement_);
      append_trailing(open_.back().lexer, result, open_.back().trailing, statement_);
      release(open_.back());
      if (result == ReadResult::End) pop();
      // What is lost of a file reads as zeros, any number of them.
      if (result == ReadResult::Broken && !sources_.problem().empty()) break;
      if (result != ReadResult::Good) continue;
      if (!open_.back().for_shapes.empty()) add_for_shapes();
      builder.set_in_model(open_.back().is_model);
      builder.apply(statement_);
      if (builder.take_model()) place_model(builder);
      auto include = builder.take_include();
      if (!include) continue;
      if (can_contribute(builder)) {
        this->include(*include);
        if (inclusion_.exhausted()) break;
      } else if (check_include_exists(reporter_, folder_, include->path, include->where)) {
        builder.leave_unread(join_path(folder_, include->path), include->where);
      }
    }
    return bytes_;
  }

 private:
  struct OpenFile {
    uint32_t file;
    Lexer lexer;
    ParameterList trailing;    ///< Those behind the Include, for the last statement.
    ParameterList for_shapes;  ///< Of a model's text: for each of its shapes.
    bool is_model = false;
    uint64_t released = 0;
  };

  /// What has been read of a large file need not stay in memory.
  void release(OpenFile& open) const {
    constexpr uint64_t kLeast = uint64_t{1} << 24;
    const uint64_t behind = open.lexer.consumed();
    if (behind - open.released < kLeast) return;
    sources_.release(open.file, open.released, behind);
    open.released = behind;
  }

  void push(uint32_t file, ParameterList trailing = {}) {
    const std::string_view text = sources_.text(file);
    bytes_ += text.size();
    open_.push_back({file, Lexer(text, file, reporter_), std::move(trailing), {}, false});
    inclusion_.enter(file);
  }

  void pop() {
    open_.pop_back();
    inclusion_.leave();
  }

  /// False when what is read now belongs to an object that the world does not place.
  bool can_contribute(const SceneBuilder& builder) {
    const ObjectDescription* object = builder.open_object();
    if (options_.read_unplaced || !object) return true;
    if (looked_ahead_in_ != builder.worlds()) {
      looked_ahead_in_ = builder.worlds();
      std::vector<ReadingPlace> places;
      for (const OpenFile& open : open_) places.push_back({open.file, open.lexer.consumed()});
      placed_ = names_of_instances(sources_, folder_, places);
    }
    return !placed_ || placed_->count(object->name) != 0;
  }

  void include(SceneBuilder::IncludeRequest& request) {
    if (const auto file = inclusion_.open(request.path, request.where)) push(*file, std::move(request.parameters));
  }

  /// A Shape of a model's text gets the parameters that the statement had which placed the model.
  void add_for_shapes() {
    if (statement_.row->name != "Shape") return;
    const ParameterList& added = open_.back().for_shapes;
    statement_.parameters.insert(statement_.parameters.end(), added.begin(), added.end());
  }

  /// Reads the statements that stand for the model of the last statement next; not where nothing places them.
  void place_model(SceneBuilder& builder) {
    const auto filename = std::find_if(statement_.parameters.begin(), statement_.parameters.end(),
                                       [](const Parameter& p) { return p.name == "filename" && !p.strings().empty(); });
    if (filename != statement_.parameters.end() && !can_contribute(builder)) {
      builder.leave_unread(join_path(folder_, filename->strings().front()), filename->where);
      return;
    }
    Diagnostics said;
    std::optional<ModelStatements> model =
        options_.models->read({statement_.parameters, statement_.where, folder_, builder.open_object() != nullptr,
                               builder.is_under_emission()},
                              said);
    for (const Diagnostic& d : said.all()) reporter_.pass(d);
    if (!model) return;
    push(sources_.add_text(std::move(model->name), std::move(model->text)));
    open_.back().for_shapes = std::move(model->for_shapes);
    open_.back().is_model = true;
  }

  Sources& sources_;
  Reporter& reporter_;
  std::string folder_;
  const ParseOptions& options_;
  Inclusion inclusion_;
  std::vector<OpenFile> open_;
  Statement statement_;
  uint64_t bytes_ = 0;
  size_t looked_ahead_in_ = 0;           ///< The world placed_ belongs to, counted from 1.
  std::optional<InstanceNames> placed_;  ///< The objects placed behind the world's first Include in an object.
};

/// True when leaving files unread was, or may have been, a mistake: an object they belong to is placed after all, or
/// something is wrong that may be right with them.
bool must_read_all(const ParseResult& result, bool needs_unread) {
  return needs_unread || std::any_of(result.scenes.begin(), result.scenes.end(), [&](const SceneDescription& world) {
           if (world.unread_files.empty()) return false;
           std::vector<bool> incomplete(world.objects.size());
           for (const UnreadFile& file : world.unread_files) incomplete[static_cast<size_t>(file.object)] = true;
           return result.diagnostics.has_errors() ||
                  std::any_of(world.instances.begin(), world.instances.end(),
                              [&](const auto& instance) { return incomplete[static_cast<size_t>(instance.object)]; });
         });
}

/// Parses the files. `needs_unread` tells whether something looks wrong that may be right with the files left unread.
ParseResult parse_once(Sources& sources, uint32_t file, const std::string& folder, const ParseOptions& options,
                       bool& needs_unread) {
  ParseResult result;
  Reporter reporter(result.diagnostics);
  if (options.models) options.models->begin();
  if (check_is_scene(sources, file, reporter)) {
    SceneBuilder builder(sources, reporter, absolute(folder), options.models);
    result.bytes = FileReader(sources, reporter, folder, options).read(file, builder);
    builder.finish(file);
    needs_unread = builder.needs_unread();
    result.scenes = builder.take_scenes();
  }
  reporter.finish();
  return result;
}

ParseResult parse(Sources& sources, uint32_t file, const std::string& folder, const ParseOptions& options) {
  bool needs_unread = false;
  ParseResult result = parse_once(sources, file, folder, options, needs_unread);
  if (must_read_all(result, needs_unread))
    result = parse_once(sources, file, folder,
                        {.read_unplaced = true, .models = options.models, .is_model = options.is_model}, needs_unread);
  if (!check_unchanged(sources, result.diagnostics)) result.scenes.clear();
  return result;
}

}  // namespace

ParseResult parse_file(Sources& sources, const std::string& path, const ParseOptions& options) {
  ParseResult result;
  const std::optional<uint32_t> file = open_main(sources, path, result.diagnostics);
  if (!file) return result;
  return parse(sources, *file, fs::path(path).parent_path().string(), options);
}

ParseResult parse_text(Sources& sources, std::string name, std::string text, std::string folder,
                       const ParseOptions& options) {
  return parse(sources, sources.add_text(std::move(name), std::move(text)), folder, options);
}

}  // namespace whit
