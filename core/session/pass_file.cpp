#include "core/session/pass_file.h"

#include <fmt/format.h>

#include <charconv>
#include <span>
#include <utility>

#include "core/base/file_names.h"
#include "core/image/atomic_file.h"
#include "core/image/checksum.h"
#include "core/session/checkpoint_file.h"

namespace whit {
namespace {

constexpr std::string_view kMagic = "whit pass\n";
constexpr const char *kPass = "the pass", *kShare = "the share";
constexpr uint32_t kMostShares = 1u << 20;

}  // namespace

std::string share_text(PassShare share) { return fmt::format("{}/{}", share.number, share.of); }

std::optional<PassShare> share_of_text(std::string_view text) {
  PassShare share;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, share.number);
  if (error != std::errc() || slash == end || *slash != '/') return {};
  const auto [stop, other_error] = std::from_chars(slash + 1, end, share.of);
  if (other_error != std::errc() || stop != end) return {};
  if (share.number < 1 || share.number > share.of || share.of > kMostShares) return {};
  return share;
}

PassFile::PassFile(const std::string& path) : file(path) {
  if (!(problem = file.error()).empty()) return;
  if (!file.bytes().starts_with(kMagic)) {
    problem = "it is no pass of a render";
    return;
  }
  const SummedBytes summed(file.bytes());
  ByteReader in(summed.bytes);
  std::string magic(kMagic.size(), ' ');
  in.numbers(std::span(magic));
  identity.restore(in);
  in.value<uint32_t>();
  if (!in.ok() || !summed.are_whole()) problem = "it is damaged: its checksum is wrong";
  pass = in.rest(), id = checksum_text(summed.sum);
}

std::string write_pass(const std::string& path, const RenderIdentity& identity, uint32_t number,
                       const FilmRender& film) {
  std::string bytes;
  ByteWriter out([&](const void* more, size_t size) { bytes.append(static_cast<const char*>(more), size); });
  out.numbers(std::span(kMagic));
  identity.save(out);
  out.value(number);
  film.save_pass(out);
  out.value(checksum(bytes));
  AtomicFile file(path);
  file.write_at(bytes.data(), bytes.size(), 0);
  return file.commit();
}

RenderIdentity identity_of_share(RenderIdentity render, const std::string& pass_id, PassShare share) {
  render.add(kPass, pass_id);
  render.add(kShare, share_text(share));
  return render;
}

PassParts::Problem PassParts::problem_of(const RenderIdentity& identity, const std::string& path,
                                         PassShare& share) const {
  const size_t n = identity.parts.size();
  const bool is_share = n >= 2 && identity.parts[n - 2].what == kPass && identity.parts[n - 1].what == kShare;
  const std::optional<PassShare> of = is_share ? share_of_text(identity.parts[n - 1].value) : std::nullopt;
  if (!of) return {Trouble::Different, fmt::format("\"{}\" is no share of a pass", path)};
  share = *of;
  const std::string other = difference(identity_of_share(render_, pass_id_, share), identity);
  if (!other.empty())
    return {Trouble::Different, fmt::format("\"{}\" is of another render or of another pass: {}", path, other)};
  if (of_ != 0 && share.of != of_) {
    return {Trouble::Different,
            fmt::format("\"{}\" is one of {} shares, and \"{}\" one of {}", path, share.of, got_.begin()->second, of_)};
  }
  if (const auto before = got_.find(share.number); before != got_.end()) {
    return {Trouble::Different,
            fmt::format("share {} is in \"{}\" and in \"{}\"", share_text(share), before->second, path)};
  }
  return {};
}

PassParts::Problem PassParts::add(FilmRender& film, const std::string& path) {
  const CheckpointFile part(path);
  const std::string unreadable = part.problem.empty() ? part.file.problem() : part.problem;
  if (!unreadable.empty()) return {Trouble::Unreadable, fmt::format("cannot join \"{}\": {}", path, unreadable)};
  PassShare share;
  if (Problem problem = problem_of(part.head.identity, path, share); problem.trouble != Trouble::None) return problem;
  if (!part.head.complete) {
    return {Trouble::Different,
            fmt::format("\"{}\" has not ended; its command with --resume {} goes on with it", path, shell_word(path))};
  }
  ByteReader in(part.state);
  if (!film.add_share(in))
    return {Trouble::Unusable, fmt::format("cannot join \"{}\": its samples are none of this pass", path)};
  if (const std::string changed = part.file.problem(); !changed.empty())
    return {Trouble::Unusable, fmt::format("cannot join \"{}\": {}", path, changed)};
  of_ = share.of, got_[share.number] = path;
  return {};
}

std::string PassParts::missing() const {
  std::string numbers;
  for (uint32_t k = 1; k <= of_; ++k) {
    if (!got_.contains(k)) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", k);
  }
  return numbers.empty() ? "" : fmt::format("of {} shares these are missing: {}", of_, numbers);
}

}  // namespace whit
