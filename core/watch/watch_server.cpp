#include "core/watch/watch_server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cmath>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "core/color/display.h"
#include "core/compare/compare.h"
#include "core/compare/report_page.h"
#include "core/image/image.h"
#include "core/watch/halves.h"
#include "core/watch/http/module.h"
#include "core/watch/page.h"
#include "core/watch/state_json.h"

namespace whit {
namespace {

/// A body is a few numbers; a reference is a picture.
constexpr size_t kShort = size_t{16} << 10, kPicture = size_t{512} << 20;
/// Pages that are open at a time; each holds a thread.
constexpr int kMostStreams = 16;

/// 32 hexadecimal digits that nobody can guess.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t n = ::getrandom(bytes.data() + have, bytes.size() - have, 0);
    if (n > 0) have += static_cast<size_t>(n);
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

/// As long as the two are, whatever they have in common.
bool same_token(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number v{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return v;
}

HttpReply refused(int status, const char* why) {
  HttpReply reply;
  reply.status = status, reply.body = fmt::format("{}\n", why);
  return reply;
}

HttpReply json_reply(std::string text) {
  HttpReply reply;
  reply.type = "application/json", reply.body = std::move(text);
  return reply;
}

HttpReply bytes_reply(const void* data, size_t size) {
  HttpReply reply;
  reply.type = "application/octet-stream";
  reply.body.assign(static_cast<const char*>(data), size);
  return reply;
}

/// A picture to compare with, on its display window.
struct Reference {
  std::string name, problem;
  uint64_t number = 0;
  PicturePlanes planes;
  int width = 0, height = 0;
  std::vector<uint16_t> halves;
};

std::shared_ptr<const Reference> make_reference(const std::string& name, const PictureFile& file, uint64_t number) {
  auto made = std::make_shared<Reference>();
  made->name = name, made->number = number;
  Result<PicturePlanes> planes = read_planes(file);
  Result<Image> image = planes.ok() ? read_image(file) : Result<Image>{};
  made->problem = planes.ok() ? image.error : planes.error;
  if (!made->problem.empty()) return made;
  made->planes = std::move(planes.value);
  const Image& pixels = image.value;
  made->width = pixels.width, made->height = pixels.height;
  std::vector<float> rgb;
  rgb.reserve(3 * static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height));
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const float* p = pixels.pixel(x, y);
      for (int c = 0; c < 3; ++c) rgb.push_back(p[std::min(c, pixels.channels - 1)]);
    }
  }
  made->halves = halves_of(rgb);
  return made;
}

/// The picture as a file would have it.
PicturePlanes planes_of(const PreviewPicture& picture) {
  PicturePlanes out;
  out.width = picture.width, out.height = picture.height, out.channels = 3;
  out.x = picture.window.min.x, out.y = picture.window.min.y;
  out.full_width = picture.resolution.x, out.full_height = picture.resolution.y;
  out.format = SampleFormat::Half;
  out.channel_names = {"R", "G", "B"};
  out.formats.assign(3, SampleFormat::Half);
  const std::vector<float> rgb = floats_of(picture.halves);
  for (size_t c = 0; c < 3; ++c) {
    std::vector<float> plane(rgb.size() / 3);
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = rgb[3 * i + c];
    out.planes.push_back(std::move(plane));
  }
  return out;
}

}  // namespace

struct WatchServer::Impl {
  Impl(Preview& shown, const WatchRequest& asked) : preview(shown), request(asked), token(random_token()) {
    DisplaySpec spec;
    spec.config_path = request.ocio, spec.view = request.view;
    const DisplayResult display = make_display_transform(spec);
    problem = display.error;
    if (display.transform) views = display.transform->view_names();
    // One that takes a number can be had only with it.
    std::erase_if(views, [](const std::string& v) { return v.rfind("exposure", 0) == 0; });
    views.insert(views.begin(), "");
    if (!request.view.empty()) views.insert(views.begin(), request.view);
    if (!request.reference.empty()) reference = make_reference(request.reference, request.reference, 1);
    if (reference && !reference->problem.empty() && problem.empty()) problem = reference->problem;
  }

  // ---- Requests ----

  /// Before anything else of it is looked at. All that is behind may rely on it.
  std::optional<HttpReply> refusal_of(const HttpRequest& asked, size_t length) const {
    if (std::find(hosts.begin(), hosts.end(), asked.host) == hosts.end()) return refused(403, "not this host");
    const bool post = asked.method == "POST";
    if ((post || !asked.origin.empty()) && asked.origin != "http://" + asked.host)
      return refused(403, "not from this page");
    if (asked.path.size() < token.size() + 2 || asked.path[0] != '/' || asked.path[token.size() + 1] != '/' ||
        !same_token(asked.path.substr(1, token.size()), token))
      return refused(404, "there is nothing here");
    const bool picture = post && what_of(asked) == "reference";
    if (length > (picture ? kPicture : post ? kShort : 0)) return refused(413, "too long");
    if (post && asked.type != (picture ? "application/octet-stream" : "application/json"))
      return refused(415, picture ? "not a picture" : "not JSON");
    return std::nullopt;
  }

  /// What is behind the token.
  std::string what_of(const HttpRequest& asked) const { return asked.path.substr(token.size() + 2); }

  HttpReply answer(const HttpRequest& asked) {
    const std::string what = what_of(asked);
    return asked.method == "POST" ? answer_post(what, asked) : answer_get(what, asked);
  }

  HttpReply answer_get(const std::string& what, const HttpRequest& asked) {
    if (what.empty()) return page();
    if (what == "events") return events();
    if (what == "state") return json_reply(state_text());
    if (what == "at") return spot(asked);
    if (what == "reference") return reference_picture();
    if (what == "report") return report();
    if (what.rfind("picture/", 0) == 0) return picture(what.substr(8), asked);
    return refused(404, "there is nothing here");
  }

  HttpReply answer_post(const std::string& what, const HttpRequest& asked) {
    if (what == "reference") return take_reference(asked);
    if (what == "camera") {
      const std::optional<CameraWish> wish = camera_wish(asked.body);
      if (!wish) return refused(400, "not a camera");
      preview.move_camera(wish->pose);
      return json_reply(problem_json(""));
    }
    if (what == "camera/write") return json_reply(problem_json(preview.write_camera()));
    if (what == "effects") {
      const std::optional<EffectSet> off = effects_wish(asked.body);
      if (!off) return refused(400, "not a list of effects");
      preview.set_effects_off(*off);
      return json_reply(problem_json(""));
    }
    return refused(404, "there is nothing here");
  }

  HttpReply page() const {
    const std::string nonce = random_token();
    HttpReply reply;
    reply.type = "text/html; charset=utf-8";
    reply.body = watch_page(nonce);
    reply.headers = {{"Content-Security-Policy",
                      fmt::format("default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; connect-src "
                                  "'self'; img-src blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors "
                                  "'none'",
                                  nonce)}};
    return reply;
  }

  std::string state_text() const {
    WatchExtras extras;
    extras.views = views;
    if (const auto r = current_reference()) {
      extras.reference = r->name, extras.reference_problem = r->problem, extras.reference_number = r->number;
      extras.reference_width = r->width, extras.reference_height = r->height;
    }
    return state_json(preview.path(), preview.state(), extras);
  }

  /// Server-sent events: the state whenever it changes, though no faster than anyone can look.
  HttpReply events() {
    if (streams.fetch_add(1) >= kMostStreams) {
      --streams;
      return refused(503, "too many pages are open");
    }
    // Counted down when the last copy goes.
    const std::shared_ptr<void> open(nullptr, [this](void*) { --streams; });
    HttpReply reply;
    reply.type = "text/event-stream";
    reply.stream = [this, open, seen = uint64_t{0}, seen_reference = uint64_t{0}](std::string& piece) mutable {
      if (stopping) return false;
      preview.wait_beyond(seen, 1000);
      if (stopping) return false;
      const uint64_t version = preview.state().version, number = reference_number();
      piece = ": here\n\n";
      if (version != seen || number != seen_reference) piece = fmt::format("data: {}\n\n", state_text());
      seen = version, seen_reference = number;
      std::this_thread::sleep_for(std::chrono::milliseconds(15));
      return true;
    };
    return reply;
  }

  HttpReply picture(const std::string& name, const HttpRequest& asked) const {
    const std::optional<uint64_t> number = number_of<uint64_t>(name);
    const auto found = number ? preview.picture(*number) : nullptr;
    if (!found) return refused(404, "this picture is not kept");
    return shown(found->halves, asked);
  }

  HttpReply reference_picture() const {
    const auto r = current_reference();
    if (!r || !r->problem.empty()) return refused(404, "there is no reference");
    return bytes_reply(r->halves.data(), r->halves.size() * sizeof(uint16_t));
  }

  /// The numbers; or with a view the bytes of a display.
  HttpReply shown(const std::vector<uint16_t>& halves, const HttpRequest& asked) const {
    const auto view = asked.query.find("view");
    if (view == asked.query.end()) return bytes_reply(halves.data(), halves.size() * sizeof(uint16_t));
    DisplaySpec spec;
    spec.config_path = request.ocio, spec.view = view->second;
    if (const auto exposure = asked.query.find("exposure"); exposure != asked.query.end()) {
      const std::optional<float> stops = number_of<float>(exposure->second);
      if (!stops || !(std::abs(*stops) <= 64)) return refused(400, "not an exposure");
      spec.exposure = *stops;
    }
    const DisplayResult display = make_display_transform(spec);
    if (!display.transform) return refused(400, "there is no such view");
    std::vector<float> rgb = floats_of(halves);
    display.transform->apply(rgb.data(), rgb.size() / 3);
    std::vector<unsigned char> bytes(rgb.size());
    std::transform(rgb.begin(), rgb.end(), bytes.begin(),
                   [](float v) { return static_cast<unsigned char>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); });
    return bytes_reply(bytes.data(), bytes.size());
  }

  HttpReply spot(const HttpRequest& asked) const {
    const auto coordinate = [&](const char* name) -> std::optional<double> {
      const auto found = asked.query.find(name);
      const auto v = found == asked.query.end() ? std::nullopt : number_of<double>(found->second);
      return v && std::abs(*v) < 1e6 ? v : std::nullopt;
    };
    const auto x = coordinate("x"), y = coordinate("y");
    if (!x || !y) return refused(400, "not a place of the picture");
    return json_reply(spot_json(preview.at({*x, *y})));
  }

  // ---- The reference ----

  std::shared_ptr<const Reference> current_reference() const {
    const std::lock_guard lock(mutex);
    return reference;
  }
  uint64_t reference_number() const {
    const auto r = current_reference();
    return r ? r->number : 0;
  }

  HttpReply take_reference(const HttpRequest& asked) {
    const auto given = asked.query.find("name");
    const std::string name = given == asked.query.end() ? "picture" : given->second.substr(0, 200);
    const auto kept = std::make_shared<const std::string>(asked.body);
    auto bytes = std::make_shared<PictureBytes>();
    bytes->name = name;
    bytes->bytes = {reinterpret_cast<const uint8_t*>(kept->data()), kept->size()};
    bytes->owner = kept;
    const std::shared_ptr<const PictureBytes> in_memory = bytes;
    const uint64_t number = reference_number() + 1;
    auto made = make_reference(name, PictureFile(in_memory), number);
    const std::string why = made->problem;
    {
      const std::lock_guard lock(mutex);
      if (why.empty()) reference = std::move(made);
    }
    return json_reply(problem_json(why));
  }

  /// The page of what the picture and the reference differ by. Its script is its own; nothing of this page is its business.
  HttpReply report() const {
    const auto r = current_reference();
    const auto now = preview.state().picture;
    if (!r || !r->problem.empty()) return refused(404, "there is no reference");
    if (!now || now->width != now->window.max.x - now->window.min.x) return refused(409, "the picture is still coarse");
    const CompareRequest how;
    const Result<PicturePair> pair = make_pair_of(planes_of(*now), r->planes, preview.path(), r->name, how.pair);
    Comparison comparison;
    if (pair.ok()) comparison = compare_pair(pair.value, how);
    else comparison.cannot = pair.error;
    ReportPage page;
    page.add(comparison, pair.ok() ? &pair.value : nullptr);
    HttpReply reply;
    reply.type = "text/html; charset=utf-8";
    reply.body = page.html(fmt::format("{} against {}", preview.path(), r->name));
    reply.headers = {{"Content-Security-Policy",
                      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
                      "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; sandbox allow-scripts"}};
    return reply;
  }

  Preview& preview;
  const WatchRequest request;
  const std::string token;
  std::string problem, address;
  std::array<std::string, 2> hosts;
  std::vector<std::string> views;
  mutable std::mutex mutex;
  std::shared_ptr<const Reference> reference;
  std::atomic<bool> stopping{false};
  std::atomic<int> streams{0};
  std::unique_ptr<HttpServer> http;
  std::thread thread;
};

WatchServer::WatchServer(Preview& preview, const WatchRequest& request)
    : impl_(std::make_unique<Impl>(preview, request)) {}
WatchServer::~WatchServer() { stop(); }

std::string WatchServer::listen() {
  Impl& of = *impl_;
  if (!of.problem.empty()) return of.problem;
  const auto check = [&of](const HttpRequest& asked, size_t length) { return of.refusal_of(asked, length); };
  of.http = http_module().make([&of](const HttpRequest& asked) { return of.answer(asked); }, check,
                               {{"Cache-Control", "no-store"},
                                {"X-Content-Type-Options", "nosniff"},
                                {"Referrer-Policy", "no-referrer"},
                                {"X-Frame-Options", "DENY"},
                                {"Cross-Origin-Resource-Policy", "same-origin"},
                                {"Cross-Origin-Opener-Policy", "same-origin"},
                                {"Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'"}});
  const int port = of.http->bind(of.request.port);
  if (port == 0)
    return of.request.port == 0 ? "no port of 127.0.0.1 is free"
                                : fmt::format(
                                      "port {} of 127.0.0.1 is taken, or not to be had; --port names another, "
                                      "and without it a free one is taken",
                                      of.request.port);
  of.hosts = {fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)};
  of.address = fmt::format("http://{}/{}/", of.hosts[0], of.token);
  of.thread = std::thread([&of] { of.http->run(); });
  return {};
}

const std::string& WatchServer::address() const { return impl_->address; }

void WatchServer::stop() {
  Impl& of = *impl_;
  of.stopping = true;
  of.preview.end_waits();
  if (!of.thread.joinable()) return;
  of.http->stop();
  of.thread.join();
}

}  // namespace whit
