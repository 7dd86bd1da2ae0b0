#include "report_html.h"

#include "report_context.h"
#include "report_text.h"
#include "text_template.h"

namespace brume
{

std::string to_html(const Comparison& comparison)
{
  nlohmann::ordered_json context = report_context(comparison);
  context["style"] = report_text::report_css;
  context["script"] = report_text::report_js;
  return fill_template(report_text::report_html, context);
}

}
