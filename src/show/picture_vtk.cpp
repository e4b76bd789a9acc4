#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkActor.h>
#include <vtkActor2D.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "core/one_thread_vtk.hpp"
#include "show/picture_layout.hpp"

// VTK requires explicit initialization of renderer and fonts.
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace plica {
namespace {

constexpr Rgb ink = {0.12, 0.12, 0.12}, grey = {0.55, 0.55, 0.55}, shell_grey = {0.45, 0.45, 0.5};
constexpr double ambient = 0.55;   // ambient part of the light; the rest comes from the viewer
constexpr int map_entries = 1024;  // size of the colour table
constexpr int samples = 4;         // multisamples per pixel, before pixels are averaged
constexpr double eye_um = 3000;    // distance of the viewer
constexpr double in_front_px = 2,
                 most_in_front_um = 1;  // offset of lines towards the viewer, so that facets do not hide them
constexpr double descender_em = 0.1;
constexpr double band_em = 0.15;              // thickness of the shell, in letter heights
constexpr double most_pixels_averaged = 5e6;  // larger pictures are not supersampled

// Polygons of equally many corners each, or lines of 2.
vtkSmartPointer<vtkPolyData> poly_data(const Vectors& points, int points_a_cell) {
  vtkNew<vtkPoints> vtk_points;
  vtk_points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const Vec3& point : points) vtk_points->InsertNextPoint(point.data());
  for (vtkIdType first = 0; first < vtk_points->GetNumberOfPoints(); first += points_a_cell) {
    cells->InsertNextCell(points_a_cell);
    for (int i = 0; i < points_a_cell; ++i) cells->InsertCellPoint(first + i);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(vtk_points);
  points_a_cell == 2 ? data->SetLines(cells) : data->SetPolys(cells);
  return data;
}

vtkSmartPointer<vtkLookupTable> colour_table(const Picture& picture) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(map_entries);
  table->SetTableRange(picture.range.low, picture.range.high);
  for (int i = 0; i < map_entries; ++i) {
    const double value = picture.range.low + (picture.range.high - picture.range.low) * (i + 0.5) / map_entries;
    const Rgb colour = colour_of(picture.field.map(), picture.range, value);
    table->SetTableValue(i, colour[0], colour[1], colour[2]);
  }
  return table;
}

void add_facets(const Scene& scene, vtkLookupTable& table, vtkRenderer& renderer) {
  const vtkSmartPointer<vtkPolyData> data = poly_data(scene.corners, 3);
  vtkNew<vtkDoubleArray> values;
  values->SetName("value");
  for (const double value : scene.values) values->InsertNextValue(value);
  data->GetPointData()->SetScalars(values);
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (const Vec3& normal : scene.normals) normals->InsertNextTuple(normal.data());
  data->GetPointData()->SetNormals(normals);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetLookupTable(&table);
  mapper->SetUseLookupTableScalarRange(true);
  mapper->SetInterpolateScalarsBeforeMapping(true);  // interpolate values rather than colours between nodes
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty& look = *actor->GetProperty();
  look.SetAmbient(scene.lit ? ambient : 1);
  look.SetDiffuse(scene.lit ? 1 - ambient : 0);
  look.SetSpecular(0);
  renderer.AddActor(actor);
}

void add_plain(vtkPolyData& data, const Rgb& colour, double opacity, double line_px, vtkRenderer& renderer) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(&data);
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkProperty& look = *actor->GetProperty();
  look.SetColor(colour[0], colour[1], colour[2]);
  look.SetOpacity(opacity);
  look.SetLineWidth(static_cast<float>(line_px));
  look.LightingOff();
  renderer.AddActor(actor);
}

void add_lines(const std::vector<Segment>& segments, const Vec3& move, const Rgb& colour, double line_px,
               vtkRenderer& renderer) {
  Vectors ends;
  for (const auto& [from, to] : segments) ends.insert(ends.end(), {from + move, to + move});
  add_plain(*poly_data(ends, 2), colour, 1, line_px, renderer);
}

// Thinner lines for small cells.
double outline_px(const Scene& scene, const Layout& layout) {
  double length_um = 0;
  for (const auto& [from, to] : scene.outlines) length_um += (to - from).norm();
  const double mean_px =
      length_um / static_cast<double>(std::max<std::size_t>(1, scene.outlines.size())) / layout.um_per_px;
  return std::min(0.06 * layout.font_px, 0.08 * mean_px);
}

/// Render window with its content, supersampled by `scale`.
class Stage {
 public:
  Stage(const Picture& picture, const Layout& layout, const std::vector<Scene>& scenes, int scale)
      : picture_(picture), layout_(layout), scale_(scale), table_(colour_table(picture)) {
    window_->SetOffScreenRendering(1);
    window_->SetSize(layout.width_px * scale, layout.height_px * scale);
    window_->SetMultiSamples(samples);
    window_->SetNumberOfLayers(2);
    vtkNew<vtkRenderer> paper;
    paper->SetBackground(1, 1, 1);
    window_->AddRenderer(paper);
    for (std::size_t i = 0; i < scenes.size(); ++i) add_panel(layout.panels[i], scenes[i]);
    overlay_->SetLayer(1);
    window_->AddRenderer(overlay_);
    add_rectangles();
    for (const Label& label : layout.labels) add_label(label);
  }

  /// Pixels as RGB, lower row first; empty if the window cannot be rendered.
  vtkSmartPointer<vtkImageData> draw() {
    auto* opengl = vtkOpenGLRenderWindow::SafeDownCast(window_);
    if (opengl == nullptr || opengl->SupportsOpenGL() == 0) return nullptr;
    window_->Render();
    vtkNew<vtkWindowToImageFilter> grab;
    grab->SetInput(window_);
    grab->SetInputBufferTypeToRGB();
    grab->ReadFrontBufferOff();
    grab->Update();
    return grab->GetOutput();
  }

 private:
  void add_panel(const Panel& panel, const Scene& scene) {
    const View& view = picture_.rows[panel.row].view;
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1, 1, 1);
    const Box& box = panel.box;
    const double width = layout_.width_px, height = layout_.height_px;
    renderer->SetViewport(box.left / width, std::max(0.0, box.bottom / height), (box.left + box.width) / width,
                          std::min(1.0, (box.bottom + box.height) / height));
    const Vec3 sight = view.sight.normalized();
    // Limited, since edges behind a face would show through it.
    const Vec3 behind = std::min(in_front_px * layout_.um_per_px, most_in_front_um) * sight;
    add_lines(scene.rest, behind, grey, 0.09 * layout_.font_px * scale_, *renderer);
    add_facets(scene, *table_, *renderer);
    add_lines(scene.outlines, -behind, ink, outline_px(scene, layout_) * scale_, *renderer);
    add_plain(*poly_data(scene.shell, 3), shell_grey, 0.6, 1, *renderer);
    vtkCamera& camera = *renderer->GetActiveCamera();
    camera.ParallelProjectionOn();
    camera.SetFocalPoint(0, 0, 0);
    const Vec3 eye = -eye_um * sight;
    camera.SetPosition(eye.x(), eye.y(), eye.z());
    camera.SetViewUp(view.up.x(), view.up.y(), view.up.z());
    camera.SetParallelScale(box.height / 2 * layout_.um_per_px);
    renderer->ResetCameraClippingRange();
    window_->AddRenderer(renderer);
  }

  void add_rectangles() {
    Vectors corners;
    vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    for (const auto& [box, colour] : layout_.rectangles) {
      const double left = box.left * scale_, right = (box.left + box.width) * scale_, bottom = box.bottom * scale_,
                   top = (box.bottom + box.height) * scale_;
      corners.insert(corners.end(), {{left, bottom, 0}, {right, bottom, 0}, {right, top, 0}, {left, top, 0}});
      colours->InsertNextTuple3(std::lround(255 * colour[0]), std::lround(255 * colour[1]),
                                std::lround(255 * colour[2]));
    }
    const vtkSmartPointer<vtkPolyData> data = poly_data(corners, 4);
    data->GetCellData()->SetScalars(colours);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor2D> actor;
    actor->SetMapper(mapper);
    overlay_->AddActor2D(actor);
  }

  void add_label(const Label& label) {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(label.text.c_str());
    vtkTextProperty& look = *actor->GetTextProperty();
    look.SetColor(ink[0], ink[1], ink[2]);
    look.SetFontSize(static_cast<int>(std::lround(label.size_px * scale_)));
    look.SetFontFamilyToArial();
    look.SetBold(label.bold);
    look.SetJustification(label.is_centred ? VTK_TEXT_CENTERED : VTK_TEXT_LEFT);
    look.SetVerticalJustificationToCentered();
    if (label.upwards) look.SetOrientation(90);
    // VTK includes descenders in the height that it centres.
    const double lower = descender_em * label.size_px;
    actor->SetPosition((label.x + (label.upwards ? lower : 0)) * scale_,
                       (label.y - (label.upwards ? 0 : lower)) * scale_);
    overlay_->AddActor2D(actor);
  }

  const Picture& picture_;
  const Layout& layout_;
  int scale_;
  vtkSmartPointer<vtkLookupTable> table_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkRenderer> overlay_;
};

// Mean of each block of `scale` x `scale` pixels.
vtkSmartPointer<vtkImageData> averaged(vtkImageData& fine, int scale) {
  const int width = fine.GetDimensions()[0] / scale, height = fine.GetDimensions()[1] / scale;
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(width, height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* from = static_cast<const unsigned char*>(fine.GetScalarPointer());
  auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
  const std::size_t row = std::size_t{3} * fine.GetDimensions()[0];
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        int sum = scale * scale / 2;  // rounds
        for (int j = 0; j < scale; ++j)
          for (int i = 0; i < scale; ++i) sum += from[(y * scale + j) * row + 3 * (x * scale + i) + channel];
        *to++ = static_cast<unsigned char>(sum / (scale * scale));
      }
  return image;
}

std::string png_bytes(vtkImageData& image) {
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(&image);
  writer->SetCompressionLevel(6);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  if (bytes == nullptr) return "";
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfTuples())};
}

/// Draw a picture; runs in the child process.
std::string draw(const Picture& picture, const Layout& layout, const std::vector<Scene>& scenes,
                 const std::string& display) {
  ::setenv("DISPLAY", display.c_str(), 1);
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 0);  // software rendering: equal pictures on any screen
  const double pixels = static_cast<double>(layout.width_px) * layout.height_px;
  const int scale = pixels > most_pixels_averaged ? 1 : 2;
  Stage stage(picture, layout, scenes, scale);
  const vtkSmartPointer<vtkImageData> image = stage.draw();
  return image == nullptr ? "" : png_bytes(*averaged(*image, scale));
}

[[noreturn]] void throw_no_screen(const std::string& why) {
  const char* named = std::getenv("DISPLAY");
  throw FileError(fmt::format("pictures need an X display: {}, and {}; apt-get install xvfb, or set DISPLAY",
                              named == nullptr || *named == '\0'
                                  ? std::string("DISPLAY is not set")
                                  : fmt::format("DISPLAY ({}) does not allow drawing", named),
                              why));
}

// Become a virtual X server, in the child process; it writes the number of its display to the socket.
int become_server(int end, int messages) {
  ::setpgid(0, 0);                     // Ctrl-C must not reach the server
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // lets it remove its socket and lock
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDWR);
  const std::string number = std::to_string(::dup(end));  // without O_CLOEXEC
  // -noreset: otherwise the server restarts when a window closes, and the next window may come too early.
  return become({"Xvfb", "-displayfd", number, "-screen", "0", "64x64x24", "-noreset", "-nolisten", "tcp"}, nothing,
                nothing, messages);
}

// Read the line that the server writes once it is ready; empty if it ends or takes too long.
std::string read_number(int end) {
  constexpr int most_ms_to_start = 30'000;
  std::string line;
  for (char letter = 0; letter != '\n';) {
    pollfd watched{end, POLLIN, 0};
    const int ready = ::poll(&watched, 1, most_ms_to_start);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0 || ::read(end, &letter, 1) != 1) return "";
    if (letter != '\n') line += letter;
  }
  return line;
}

std::string last_line(std::FILE* messages) {
  std::string text(1 << 14, '\0');
  std::rewind(messages);
  text.resize(std::fread(text.data(), 1, text.size(), messages));
  text.erase(text.find_last_not_of(" \n") + 1);
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

// X display: that of DISPLAY, or an own virtual X server (Xvfb), which ends with this object or, however it ends, this
// process.
struct Painter::Screen {
  std::string display;
  std::unique_ptr<ChildProcess> server;

  void start_server() {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages(std::tmpfile(), std::fclose);
    if (messages == nullptr) throw_no_screen("Xvfb cannot be started");
    try {
      server = std::make_unique<ChildProcess>([&](int end) { return become_server(end, ::fileno(messages.get())); });
    } catch (const FileError&) {
      throw_no_screen("a process cannot be started");
    }
    const std::string number = read_number(server->end());
    display = ":" + number;
    if (!number.empty()) return;
    server->send(SIGTERM);
    const int status = server->wait();
    server.reset();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw_no_screen("Xvfb is not installed");
    const std::string said = last_line(messages.get());
    throw_no_screen("Xvfb did not start" + (said.empty() ? said : " (" + said + ")"));
  }
};

Painter::Painter() : screen_(std::make_unique<Screen>()) {
  if (const char* named = std::getenv("DISPLAY")) screen_->display = named;
  if (screen_->display.empty()) screen_->start_server();
}
Painter::~Painter() = default;

std::string Painter::png(const Picture& picture) {
  const Layout layout = make_layout(picture);
  const double band_um = band_em * layout.font_px * layout.um_per_px;
  std::vector<Scene> scenes;
  for (const Panel& panel : layout.panels)
    scenes.push_back(make_scene(picture, picture.columns[panel.column], picture.rows[panel.row].view, band_um));
  while (true) {
    const auto bytes = output_of_child("drawing a picture on display " + screen_->display,
                                       [&] { return draw(picture, layout, scenes, screen_->display); });
    if (bytes && !bytes->empty()) return *bytes;
    if (screen_->server != nullptr)
      throw FileError("pictures cannot be drawn (OpenGL failed in VTK); apt-get install libgl1-mesa-dri");
    screen_->start_server();  // that of DISPLAY does not respond, or cannot draw
  }
}

}  // namespace plica
