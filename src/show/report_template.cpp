#include "show/report_page.hpp"

#ifdef PLICA_REPORT_TEMPLATE
// Included by the assembler, since the compiler takes seconds for literals of this size.
__asm__(
    ".pushsection .rodata\n"
    "plica_report_template_begin:\n"
    ".incbin \"" PLICA_REPORT_TEMPLATE
    "\"\n"
    "plica_report_template_end:\n"
    ".byte 0\n"
    "plica_study_template_begin:\n"
    ".incbin \"" PLICA_STUDY_TEMPLATE
    "\"\n"
    "plica_study_template_end:\n"
    ".byte 0\n"
    ".popsection\n");
extern "C" const char plica_report_template_begin[], plica_report_template_end[];
extern "C" const char plica_study_template_begin[], plica_study_template_end[];
#endif

namespace plica {

std::string_view report_template() {
#ifdef PLICA_REPORT_TEMPLATE
  return {plica_report_template_begin, plica_report_template_end};
#else
  return {};
#endif
}

std::string_view study_template() {
#ifdef PLICA_REPORT_TEMPLATE
  return {plica_study_template_begin, plica_study_template_end};
#else
  return {};
#endif
}

}  // namespace plica
