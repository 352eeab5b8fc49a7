// The report as one page that needs nothing else: no script, no network. Style: report_style.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/accuracy/report.h"
#include "core/accuracy/report_chart.h"
#include "core/accuracy/report_picture.h"
#include "core/accuracy/report_style.h"
#include "core/accuracy/report_words.h"
#include "core/base/plain_text.h"
#include "core/compare/page_style.h"

namespace whit {
namespace {

constexpr int kPictureWidth = 1080, kThumbWidth = 224, kCropWidth = 344;  // At most, in pixels of the file.
constexpr size_t kShownWorst = 12;

std::string head(const CostReport& report) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>What accuracy "
      "costs: "
      "{}</title>\n<style>{}{}</style>\n</head>\n<body>\n<main>\n",
      html_text(report.scene), kPageStyle, kReportStyle);
  out +=
      fmt::format("<header>\n<h1>What accuracy costs in time</h1>\n<p class=\"scene\">{}</p>\n<p>{}</p>\n<p>{}</p>\n",
                  html_text(report.scene),
                  html_text(fmt::format("{} × {} pixels, {} integrator, {} sampler, {} samples asked for. {}.",
                                        report.resolution.x, report.resolution.y, report.integrator, report.sampler,
                                        report.own_samples, report.machine)),
                  html_text(reference_text(report)));
  if (!report.complete) out += "<p class=\"early\">The study ended early: this is what was measured by then.</p>\n";
  return out + "</header>\n";
}

std::string range_chip(const char* what, const std::string& low, const std::string& high) {
  return fmt::format("<span>{} {} to {}</span>", what, low, high);
}

std::string answer(const CostAnswer& a) {
  std::string chips;
  if (a.nrmse.high > 0) chips += range_chip("nRMSE", percent_text(a.nrmse.low), percent_text(a.nrmse.high));
  if (a.cpu_seconds.high > 0)
    chips += range_chip("CPU", seconds_text(a.cpu_seconds.low), seconds_text(a.cpu_seconds.high));
  if (a.extrapolated) chips += "<span class=\"guess\">extrapolated</span>";
  std::string out = fmt::format("<li class=\"card\"><p>{}</p>", html_text(a.text));
  if (!chips.empty()) out += fmt::format("<div class=\"chips\">{}</div>", chips);
  if (!a.command.empty()) out += fmt::format("<code class=\"paste\">{}</code>", html_text(a.command));
  return out + "</li>\n";
}

std::string answers(const CostReport& report) {
  if (report.answers.empty()) return "";
  std::string out = "<section>\n<h2>Answers</h2>\n<ul class=\"answers\">\n";
  for (const CostAnswer& a : report.answers) out += answer(a);
  return out + "</ul>\n</section>\n";
}

// order_text() with its power raised.
std::string order_html(const CostReport& report) {
  const std::string text = order_text(report);
  const size_t power = text.find('^'), end = text.find(' ', power);
  if (power == std::string::npos) return html_text(text);
  return html_text(text.substr(0, power)) + "<sup>" + html_text(text.substr(power + 1, end - power - 1)) + "</sup>" +
         html_text(text.substr(end));
}

std::string chart(const CostReport& report) {
  const std::string wide = error_chart(report, 1040, 520);
  if (wide.empty()) return "";
  std::string out = "<section>\n<h2>Error against time</h2>\n<p class=\"lead\">";
  out += order_html(report) + html_text("; a picture takes " + time_text(report) + " of CPU time. ");
  out += "Bars and bands are intervals of 95 %; dashed is what four times the samples would give.</p>\n";
  return out +
         fmt::format(
             "<div class=\"card\"><div class=\"wide\">{}</div><div class=\"narrow\">{}</div>{}</div>\n</section>\n",
             wide, error_chart(report, 400, 420), error_legend(report));
}

std::string cell(const char* kind, const std::string& content) {
  return *kind ? fmt::format("<td class=\"{}\">{}</td>", kind, content) : fmt::format("<td>{}</td>", content);
}

// "0.940 %" large and "[0.810, 1.00]" small.
std::string interval_html(const std::string& text) {
  const size_t bracket = text.find('[');
  if (bracket == std::string::npos) return html_text(text);
  return html_text(text.substr(0, bracket)) + "<small>" + html_text(text.substr(bracket)) + "</small>";
}

std::string setting_row(const CostSetting& s, bool with_bias) {
  std::string out = s.pareto ? "<tr>" : "<tr class=\"beaten\">";
  out += cell("left", html_text(setting_name(s)) + (s.pareto ? " <span class=\"star\">★</span>" : ""));
  out += cell("", interval_html(seconds_interval(s.cpu_seconds))) + cell("", html_text(seconds_text(s.seconds.value)));
  out += cell("", interval_html(percent_interval(s.nrmse))) + cell("", html_text(percent_text(s.upper95)));
  if (with_bias) out += cell("", s.bias ? interval_html(percent_interval(*s.bias)) : "");
  for (const std::string& what :
       {percent_text(s.share_2_255), percent_text(s.quantile95), three_digits(s.relmse), three_digits(s.flip)})
    out += cell("", html_text(what));
  return out + "</tr>\n";
}

std::string settings(const CostReport& report) {
  if (report.settings.empty()) return "";
  const bool with_bias = std::any_of(report.settings.begin(), report.settings.end(), [](auto& s) { return s.bias; });
  std::string out =
      "<section>\n<h2>What was measured</h2>\n<p class=\"lead\">nRMSE, the root mean square error over the mean "
      "radiance in "
      "linear light, is the measure with a promise; those to the right of it are without.</p>\n<div class=\"card "
      "scroll\"><table>\n<thead><tr><th class=\"left\">setting</th><th>CPU "
      "time</th><th>wall</th><th>nRMSE</th><th>below, "
      "95&nbsp;% sure</th>";
  if (with_bias) out += "<th>bias, at any number of samples</th>";
  out +=
      "<th>pixels off by more than 2/255</th><th>95&nbsp;% are off by less than</th><th>relMSE</th><th>FLIP</th></tr>"
      "</thead>\n<tbody>\n";
  for (const CostSetting& s : report.settings) out += setting_row(s, with_bias);
  out +=
      "</tbody></table></div>\n<p class=\"under\"><span class=\"star\">★</span> nothing measured is both faster and "
      "nearer. Times: the median of ";
  return out + fmt::format(
                   "{} runs, [least, greatest]. relMSE is relative to ref² + (0.1 mean radiance)². FLIP is the mean "
                   "over the display picture at 67 pixels per degree.</p>\n</section>\n",
                   report.replicates);
}

std::string effect_row(const CostReport& report, const CostEffect& e) {
  const std::string seconds = e.resolved ? interval_html(effect_seconds(e))
                                         : "<span class=\"unresolved\">" + interval_html(effect_seconds(e)) + "</span>";
  std::string out = "<tr>" + cell("left effect",
                                  fmt::format("<b>{}</b><br><code>{}</code>", html_text(e.name), html_text(e.command)));
  out += cell("", seconds) + cell("left", effect_bar(report, e)) +
         cell("", e.resolved ? html_text(percent_text(e.share)) : "");
  out += cell("", html_text(signed_percent_text(e.mean_change))) + cell("", html_text(percent_text(e.pixels_changed)));
  const double scale = heat_scale(e.where);
  const std::string where = heat_address(e.where, scale, kThumbWidth);
  return out +
         cell("left", where.empty() ? ""
                                    : fmt::format("<img class=\"thumb\" src=\"{}\" alt=\"Where {} changes the "
                                                  "picture\"><small>white: {} of the mean</small>",
                                                  where, html_text(e.name), html_text(percent_text(scale)))) +
         "</tr>\n";
}

std::string effects(const CostReport& report) {
  if (report.effects.empty()) return "";
  std::string out =
      "<section>\n<h2>What the effects cost and change</h2>\n<p class=\"lead\">Each is the scene without this one, "
      "against the scene as it is, in pairs. Effects interact: the columns need not add up.</p>\n<div class=\"card "
      "scroll\"><table>\n<thead><tr><th class=\"left\">effect</th><th>CPU time it takes</th><th></th><th>of "
      "all</th><th>changes the mean by</th><th>pixels changed by more than 1&nbsp;%</th><th "
      "class=\"left\">where</th></tr></thead>\n<tbody>\n";
  for (const CostEffect& e : report.effects) out += effect_row(report, e);
  return out +
         "</tbody></table></div>\n<p class=\"under\">Not resolved: the interval of 95&nbsp;% holds zero, so that "
         "nothing is known but that it is small.</p>\n</section>\n";
}

std::string crop_figure(const CostSetting& s) {
  const std::string address = picture_address(s.crop, kCropWidth);
  if (address.empty()) return "";
  const std::string name = html_text(setting_name(s));
  return fmt::format("<figure><img src=\"{}\" alt=\"{}\"><figcaption><b>{}</b><br>{} in {}</figcaption></figure>\n",
                     address, name, name, html_text(percent_text(s.nrmse.value)),
                     html_text(seconds_text(s.cpu_seconds.value)));
}

std::string crops(const CostReport& report) {
  std::string levels, others;
  for (const CostSetting& s : report.settings) (s.knob == "samples" ? levels : others) += crop_figure(s);
  if (levels.empty() && others.empty()) return "";
  std::string out =
      "<section>\n<h2>The same place</h2>\n<p class=\"lead\">With the error of the whole picture, and its CPU "
      "time.</p>\n";
  for (const std::string& strip : {levels, others})
    if (!strip.empty()) out += "<div class=\"strip\">\n" + strip + "</div>\n";
  return out + "</section>\n";
}

std::string circles(const CostReport& report) {
  const Vec2i size = report.resolution;
  if (size.x <= 0 || size.y <= 0) return "";
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\" aria-hidden=\"true\">", size.x, size.y);
  for (size_t i = 0; i < std::min(kShownWorst, report.worst.size()); ++i)
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{:.2f}\"/>", report.worst[i].pixel.x + 0.5,
                       report.worst[i].pixel.y + 0.5, 0.016 * size.x);
  return out + "</svg>";
}

std::string worst_table(const CostReport& report) {
  if (report.worst.empty()) return "";
  std::string out =
      "<div class=\"card scroll\"><table>\n<thead><tr><th>share of the squared "
      "error</th><th class=\"left\">of</th><th class=\"left\">light</th><th class=\"left\">worst "
      "pixel</th></tr></thead>\n<tbody>\n";
  for (size_t i = 0; i < std::min(kShownWorst, report.worst.size()); ++i) {
    const CostWorst& w = report.worst[i];
    out += "<tr>" + cell("", html_text(percent_text(w.share))) +
           cell("left text", w.shape.empty() ? "nothing: rays leave the scene" : html_text(w.shape)) +
           cell("left text", html_text(w.light)) + cell("left", fmt::format("({}, {})", w.pixel.x, w.pixel.y)) +
           "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string where_error_is(const CostReport& report) {
  const std::string picture = picture_address(report.picture, kPictureWidth);
  const double scale = heat_scale(report.error);
  const std::string error = heat_address(report.error, scale, kPictureWidth);
  if (picture.empty() && error.empty() && report.half_error_pixels == 0) return "";
  std::string out = "<section>\n<h2>Where the error is</h2>\n";
  const double all = double(report.resolution.x) * report.resolution.y;
  if (report.half_error_pixels > 0 && all > 0)
    out += fmt::format(
        "<p class=\"lead\">Half of the squared error is in {} pixels, {} of all. Circles mark the worst "
        "pixels of the {} things that carry most.</p>\n",
        report.half_error_pixels, percent_text(double(report.half_error_pixels) / all),
        std::min(kShownWorst, report.worst.size()));
  out += "<div class=\"pair\">\n";
  if (!picture.empty())
    out += fmt::format(
        "<figure><div class=\"marked\"><img src=\"{}\" alt=\"The picture\">{}</div><figcaption>The picture at "
        "the last level.</figcaption></figure>\n",
        picture, circles(report));
  if (!error.empty())
    out += fmt::format(
        "<figure><div class=\"marked\"><img src=\"{}\" alt=\"Its error\">{}</div><figcaption>Its error: 0 <span "
        "class=\"ramp\"></span> {} of the mean radiance and above.</figcaption></figure>\n",
        error, circles(report), html_text(percent_text(scale)));
  return out + "</div>\n" + worst_table(report) + "</section>\n";
}

std::string not_known(const CostReport& report) {
  if (report.not_known.empty()) return "";
  std::string out = "<section>\n<h2>What is not known</h2>\n<ul class=\"unknown\">\n";
  for (const std::string& what : report.not_known) out += "<li>" + html_text(what) + "</li>\n";
  return out + "</ul>\n</section>\n";
}

}  // namespace

std::string cost_html(const CostReport& report) {
  return head(report) + answers(report) + chart(report) + settings(report) + effects(report) + crops(report) +
         where_error_is(report) + not_known(report) + "</main>\n</body>\n</html>\n";
}

}  // namespace whit
