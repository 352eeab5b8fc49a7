#include "core/watch/page.h"

#include <fmt/format.h>

#include "core/compare/colour_maps.h"
#include "core/compare/page_data.h"
#include "core/compare/page_script_base.h"
#include "core/compare/page_style.h"
#include "core/compare/page_viewer_style.h"
#include "core/watch/page_markup.h"
#include "core/watch/page_script_camera.h"
#include "core/watch/page_script_main.h"
#include "core/watch/page_script_panel.h"
#include "core/watch/page_script_picture.h"
#include "core/watch/page_style.h"

namespace whit {
std::string watch_page(const std::string& nonce) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n<title>whit "
      "watch</title>\n<style nonce=\"{}\">{}{}{}</style>\n</head>\n<body>\n",
      nonce, kPageStyle, kPageViewerStyle, kWatchStyle);
  out += kWatchMarkup;
  out += fmt::format(
      "<script type=\"application/json\" nonce=\"{0}\" id=\"maps\">{{\"magma\":\"{1}\"}}</script>\n<script "
      "nonce=\"{0}\">\n\"use strict\";\n",
      nonce, hex_text(kMagma));
  for (const char* piece :
       {kPageScriptBase, kWatchScriptPicture, kWatchScriptPanel, kWatchScriptCamera, kWatchScriptMain})
    out += piece;
  return out + "</script>\n</body>\n</html>\n";
}

}  // namespace whit
