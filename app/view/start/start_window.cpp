#include "view/start/start_window.h"

#include <epoxy/gl.h>
// After the header above, which includes OpenGL.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "log/logger.h"
#include "share/run_attachment.h"
#include "share/shared_memory.h"
#include "user_folders.h"
#include "view/content/content.h"
#include "view/content/window_loop.h"
#include "view/playback/recording_player.h"
#include "view/playback/recording_view.h"
#include "view/run_follower.h"
#include "view/start/file_dialog.h"
#include "view/start/start_flow.h"
#include "view/start/start_page.h"
#include "view/start/thumbnails.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

constexpr double kAwake = 0.5;  // s of pictures after an input [chosen: menus open at once]

/// Returns a name for a run that no other run has: that of the scene, or with a number.
std::string free_run_name(const std::string& scene) {
  const std::string name = scene::as_file_name(scene);
  const auto runs = session::running_runs();
  const auto taken = [&runs](const std::string& wanted) {
    return std::any_of(runs.begin(), runs.end(),
                       [&wanted](const auto& run) { return run.name == wanted; });
  };
  std::string free = name;
  for (int number = 2; taken(free); ++number) free = name + "-" + std::to_string(number);
  return free;
}

/// A mesh that was read: its values and its scene.
struct ReadMesh {
  MeshTouch touch;
  MeshScene scene;
};

/// Makes the scene of a mesh, with suitable values if none are given.
driver::Result<ReadMesh> read_mesh(const fs::path& mesh, std::optional<MeshTouch> touch) {
  if (!touch) {
    const auto suggested = suggest_touch(mesh);
    if (!suggested) return suggested.error();
    touch = *suggested;
  }
  auto scene = make_mesh_scene(mesh, *touch, draft_of(mesh));
  if (!scene) return scene.error();
  return ReadMesh{*touch, std::move(scene).value()};
}

class StartWindow {
 public:
  StartWindow(Screen& screen, const StartSetup& setup, const WindowChoice& choice)
      : screen_(screen),
        setup_(setup),
        choice_(choice),
        recent_(RecentFiles::load(RecentFiles::default_file())) {
    screen_.set_scale(choice.ui_scale);
    if (!recent_.warning().empty()) scene::logger().warn("{}", recent_.warning());
    if (!setup.path_hand) model_.hand = choice.hand;
    model_.dark = choice.theme == Theme::kDark;
    model_.can_browse = dialog_.available();
    model_.set_groups(start_groups(recent_));
    if (!setup.open.empty()) open(setup.open);
  }
  ~StartWindow() { end_run(); }

  driver::Result<AfterPicture> draw(double dt) {
    step_run();
    step_mesh();
    for (const std::string& file : screen_.take_drops()) open(file);
    if (const auto path = dialog_.take_path()) open(*path);
    return flow_.stage() == StartStage::kShown ? draw_content(dt) : draw_page(dt);
  }

 private:
  Theme theme() const { return model_.dark ? Theme::kDark : Theme::kLight; }
  WindowChoice content_choice() const {
    WindowChoice choice = choice_;
    choice.theme = theme();
    if (model_.hand) choice.hand = *model_.hand;
    return choice;
  }
  void show_error(const std::string& message) {
    model_.message = message;
    model_.message_is_error = true;
  }

  driver::Result<AfterPicture> draw_page(double dt);
  driver::Result<AfterPicture> draw_content(double dt);
  void obey(StartRequest request);
  void open(const std::string& text);
  void run_selected();
  void begin_run(const StartEntry& entry);
  void play(const StartEntry& entry);
  void show_run();
  void step_run();
  void end_run();
  void go_back();
  void make_mesh();
  void step_mesh();
  void save_mesh();
  void remember(const fs::path& file);

  Screen& screen_;
  const StartSetup setup_;
  const WindowChoice choice_;
  RecentFiles recent_;
  FileDialog dialog_;
  Thumbnails thumbnails_;
  StartPage page_;
  StartModel model_;
  StartFlow flow_;
  double awake_ = kAwake;  // s of pictures without an input that are left

  std::unique_ptr<ChildProcess> process_;  // of the run
  std::vector<std::string> command_;       // its arguments
  std::string run_;                        // its name
  // What is shown, in the order in which it depends on each other.
  std::unique_ptr<session::RunAttachment> attachment_;
  std::unique_ptr<RecordingView> recording_;
  std::unique_ptr<TouchSource> source_;
  std::unique_ptr<Content> content_;

  fs::path mesh_;                              // the mesh that the fields belong to
  std::future<driver::Result<ReadMesh>> job_;  // the mesh that is read
  std::optional<MeshScene> made_;
  bool make_again_ = false;  // the values have changed since
  bool run_when_made_ = false;
};

void StartWindow::remember(const fs::path& file) {
  if (const auto written = recent_.add(file); !written) {
    scene::logger().warn("The list of recent files is not written: {}", written.error().message);
  }
  model_.set_groups(start_groups(recent_));
  model_.select(file);
}

void StartWindow::open(const std::string& text) {
  const auto opened = open_text(text);
  if (flow_.stage() != StartStage::kChoosing) go_back();
  if (!opened) return show_error(opened.error().message);
  model_.message.clear();
  model_.path.clear();
  remember(opened->file);
  if (opened->kind == FileKind::kMesh) make_mesh();
}

void StartWindow::make_mesh() {
  const StartEntry* const entry = model_.entry();
  if (entry == nullptr || entry->kind != FileKind::kMesh) return;
  if (job_.valid()) {
    make_again_ = true;
    return;
  }
  std::optional<MeshTouch> touch;
  if (entry->file == mesh_) {
    touch = model_.touch;
  } else {
    mesh_ = entry->file;
    model_.save_name = entry->name;
  }
  made_.reset();
  model_.notes.clear();
  model_.message.clear();
  model_.reading = true;
  job_ = std::async(std::launch::async, read_mesh, mesh_, touch);
}

void StartWindow::step_mesh() {
  if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  auto made = job_.get();
  model_.reading = false;
  if (std::exchange(make_again_, false)) return make_mesh();
  if (!made) {
    run_when_made_ = false;
    mesh_.clear();  // The next choice of this mesh reads it again.
    return show_error(made.error().message);
  }
  model_.touch = made->touch;
  model_.notes = made->scene.notes;
  made_ = std::move(made).value().scene;
  if (std::exchange(run_when_made_, false)) run_selected();
}

void StartWindow::save_mesh() {
  if (!made_ || job_.valid())
    return show_error("The mesh is still read. Save the scene afterwards.");
  const auto saved = save_mesh_scene(*made_, model_.save_name);
  if (!saved) return show_error(saved.error().message);
  model_.set_groups(start_groups(recent_));
  model_.message = "Saved: " + saved->string();
  model_.message_is_error = false;
}

void StartWindow::obey(StartRequest request) {
  switch (request) {
    case StartRequest::kNone:
      break;
    case StartRequest::kRun:
      run_selected();
      break;
    case StartRequest::kCancel:
      go_back();
      break;
    case StartRequest::kOpen:
      open(std::string(model_.path));
      break;
    case StartRequest::kBrowse:
      if (const auto asked = dialog_.ask(); !asked) show_error(asked.error().message);
      break;
    case StartRequest::kMakeScene:
      make_mesh();
      break;
    case StartRequest::kSave:
      save_mesh();
      break;
  }
}

void StartWindow::run_selected() {
  const StartEntry* const entry = model_.entry();
  if (entry == nullptr || flow_.stage() != StartStage::kChoosing) return;
  model_.message.clear();
  if (entry->kind == FileKind::kRecording) return play(*entry);
  if (entry->kind == FileKind::kMesh && (job_.valid() || !made_ || entry->file != mesh_)) {
    run_when_made_ = true;
    if (!job_.valid()) make_mesh();
    return;
  }
  begin_run(*entry);
}

void StartWindow::play(const StartEntry& entry) {
  auto recording = RecordingView::open({entry.file});
  if (!recording) return show_error(recording.error().message);
  recording_ = std::move(recording).value();
  source_ = std::make_unique<RecordingPlayer>(*recording_, entry.file.stem());
  content_ = std::make_unique<Content>(screen_, *source_, content_choice());
  content_->offer_start_window();
  remember(fs::path(entry.file));
  flow_.shown();
}

void StartWindow::begin_run(const StartEntry& entry) {
  const auto hand = hand_for(model_, entry);
  run_ = free_run_name(entry.name);
  command_ = {"run",   entry.scene.string(), "--no-view", "--clock",
              "paced", "--reload",           "--name",    run_};
  if (hand) {
    command_.insert(command_.end(),
                    {"--hand", std::string(kHandSources[static_cast<std::size_t>(*hand)])});
  }
  auto started = ChildProcess::start(setup_.thimble, command_, {.keep_errors = true});
  if (!started) return show_error(started.error().message);
  process_ = std::move(started).value();
  flow_.run_started();
  remember(fs::path(entry.file));
}

void StartWindow::show_run() {
  attachment_ = std::make_unique<session::RunAttachment>(run_);
  source_ = std::make_unique<RunFollower>(*attachment_);
  content_ = std::make_unique<Content>(screen_, *source_, content_choice());
  content_->offer_start_window();
  content_->set_own_run(true);
  content_->set_can_run_again(true);
  flow_.shown();
}

void StartWindow::step_run() {
  if (!process_) return;
  if (flow_.stage() == StartStage::kStarting) {
    const auto runs = session::running_runs();
    const bool there =
        std::any_of(runs.begin(), runs.end(), [this](const auto& run) { return run.name == run_; });
    if (there && session::SharedReader::attach(run_)) show_run();
  }
  const auto code = process_->ended();
  if (!code) return;
  flow_.run_ended(*code, process_->text());
  process_.reset();
  if (flow_.message().empty()) return;
  if (flow_.stage() == StartStage::kShown) {
    content_->show_message(flow_.message());
  } else {
    show_error(flow_.message());
  }
}

void StartWindow::end_run() {
  if (!process_) return;
  if (!process_->ended())
    scene::terminal().info("The window ends the run {} that it started.", run_);
  process_.reset();
}

void StartWindow::go_back() {
  flow_.back();
  end_run();
  if (content_) model_.dark = content_->theme() == Theme::kDark;
  content_.reset();
  source_.reset();
  attachment_.reset();
  recording_.reset();
  model_.starting = false;
  glfwSetWindowTitle(screen_.window(), "Thimble");
  awake_ = kAwake;
}

driver::Result<AfterPicture> StartWindow::draw_content(double dt) {
  if (auto drawn = content_->draw(dt); !drawn) return drawn.error();
  if (content_->wants_to_close()) return AfterPicture::kClose;
  if (content_->take_run_again() && flow_.run_again()) {
    auto started = ChildProcess::start(setup_.thimble, command_, {.keep_errors = true});
    if (started) {
      process_ = std::move(started).value();
      flow_.run_started();
    } else {
      content_->show_message(started.error().message);
    }
  }
  const bool still = content_->still() && !process_;
  if (content_->take_back()) go_back();
  return still ? AfterPicture::kStill : AfterPicture::kMoves;
}

driver::Result<AfterPicture> StartWindow::draw_page(double dt) {
  screen_.begin(theme());
  int pixels_x = 0;
  int pixels_y = 0;
  glfwGetFramebufferSize(screen_.window(), &pixels_x, &pixels_y);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels_x, pixels_y);
  const Colour ground = colours_of(theme()).sky;
  glClearColor(ground[0], ground[1], ground[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  const ImGuiIO& io = ImGui::GetIO();
  const std::vector<int> keys = screen_.take_keys();
  const bool input = io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseDown[0] ||
                     io.MouseWheel != 0 || !keys.empty() || io.WantTextInput;
  awake_ = input ? kAwake : awake_ - dt;
  model_.starting = flow_.stage() == StartStage::kStarting;
  const StartRequest request = page_.draw(
      {0, 0, io.DisplaySize.x, io.DisplaySize.y}, screen_.scale(), keys,
      [this](const StartEntry& entry) { return thumbnails_.texture(entry); }, model_);
  screen_.end();
  thumbnails_.step();
  obey(request);
  return awake_ > 0 || flow_.stage() != StartStage::kChoosing ? AfterPicture::kMoves
                                                              : AfterPicture::kStill;
}

}  // namespace

driver::Result<void> show_start_window(const StartSetup& setup, const WindowChoice& choice) {
  auto screen = Screen::open();
  if (!screen) return screen.error();
  return draw_until_closed(**screen, choice, start_window_on(**screen, setup, choice));
}

DrawPicture start_window_on(Screen& screen, const StartSetup& setup, const WindowChoice& choice) {
  auto window = std::make_shared<StartWindow>(screen, setup, choice);
  return [window](double dt) { return window->draw(dt); };
}

}  // namespace thimble::view
