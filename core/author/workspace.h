// The files that an editor works on: those that are open, as they are there, and those they belong to, from the disk.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/author/diagnose.h"
#include "core/author/document.h"
#include "core/author/index.h"

namespace whit::author {

/// A file, open or not.
struct File {
  std::string path;  ///< Canonical.
  std::string uri;   ///< As the editor calls it; "" where it has not.
  Document document;
  FileIndex index;
  bool open = false;
  int64_t version = 0;
  int64_t stamp = -1;  ///< Of a file from the disk: when it was written.
  uint64_t bytes = 0;  ///< And its size.

  std::string_view text() const { return document.text(); }
};

class Workspace {
 public:
  Encoding encoding = Encoding::Utf16;
  std::vector<std::string> folders;  ///< Of the workspace: how far up main files are looked for.

  File& open(const std::string& path, const std::string& uri, std::string text, int64_t version);
  /// A piece of an open file becomes other text; without a place all of it.
  void change(File& file, Position begin, Position end, std::string_view text);
  void replace(File& file, std::string text);
  void close(File& file);

  /// The file of a path as it is now, read from the disk where nobody has it open; null where there is none.
  File* find(const std::string& path);
  std::vector<File*> open_files();
  std::vector<OpenText> open_texts();

  /// The file from whose folder the names in `file` start: one that includes it where it is no whole scene itself.
  File* main_of(File& file);

  /// The path of a file that a scene names.
  std::string resolve(const File& main, const std::string& name);

  /// Goes through the statements of a scene in the order in which they are read, until `visit` returns false.
  using Visit = std::function<bool(File&, size_t item)>;
  void walk(File& main, const Visit& visit);
  /// All files of a scene, each once.
  std::vector<File*> files_of(File& main);

  /// Files on the disk may have come and gone.
  void refresh() { canonical_.clear(), alone_.clear(), look_again(); }

  /// The disk is looked at once for each file until this is called, so that none changes while somebody goes through it.
  void look_again() { looked_at_.clear(); }

 private:
  bool walk_file(const File& main, File& file, const Visit& visit, std::vector<const File*>& reading);
  File* look_at(const std::string& canonical);
  File* read(const std::string& canonical);
  bool includes(File& main, const File& wanted);
  std::vector<std::string> candidates(const File& file) const;
  const std::string& canonical(const std::string& path);

  std::map<std::string, std::unique_ptr<File>> files_;
  std::unordered_map<std::string, std::string> canonical_;
  std::unordered_map<std::string, std::string> main_of_;  ///< Found before.
  std::set<std::string> alone_;                           ///< Files for which none was found on the disk.
  uint64_t walked_ = 0;                                   ///< Files so far, each as often as it is included.
  std::unordered_map<std::string, File*> looked_at_;      ///< On the disk; null where there is none.
};

}  // namespace whit::author
