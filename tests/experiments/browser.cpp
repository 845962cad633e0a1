#include "tests/experiments/browser.h"

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/experiments/program.h"

namespace plumb {
namespace {

using Json = nlohmann::json;

constexpr int patience_ms = 60'000;  // a loaded machine takes seconds to start Chromium; none takes a minute

struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
        read = ends[0], write = ends[1];
    }
};

// In the child: the browser reads from descriptor 3 and writes to 4.
[[noreturn]] void become_browser(const std::string& program, const std::filesystem::path& profile, int input,
                                 int output) {
    ::setpgid(0, 0);
    const int safe_input = ::fcntl(input, F_DUPFD, 10), safe_output = ::fcntl(output, F_DUPFD, 10);
    ::dup2(safe_input, 3);
    ::dup2(safe_output, 4);
    ::close(safe_input), ::close(safe_output);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int descriptor : {0, 1, 2}) ::dup2(nowhere, descriptor);
    const std::string folder = fmt::format("--user-data-dir={}", profile.string());
    ::execlp(program.c_str(), program.c_str(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
             "--no-first-run", "--hide-scrollbars", "--remote-debugging-pipe", folder.c_str(), "about:blank", nullptr);
    ::_exit(127);
}

Json parse_key(const std::string& key) {
    Json event = {{"key", key}, {"code", key}};
    if (key.size() == 1) {
        event["text"] = key;
        if (key[0] >= '0' && key[0] <= '9') event["code"] = fmt::format("Digit{}", key);
        event["windowsVirtualKeyCode"] = static_cast<int>(key[0]);
    }
    const std::pair<const char*, int> named[] = {{"Enter", 13},   {"Tab", 9},         {"ArrowLeft", 37},
                                                 {"ArrowUp", 38}, {"ArrowRight", 39}, {"ArrowDown", 40}};
    for (const auto& [name, number] : named) {
        if (key == name) event["windowsVirtualKeyCode"] = number;
    }
    if (key == "Enter") event["text"] = "\r";
    return event;
}

}  // namespace

class Browser::Connection {
public:
    explicit Connection(const std::filesystem::path& profile) {
        const Pipe to_browser, from_browser;
        const std::string name = program();
        process_ = ::fork();
        if (process_ < 0) throw std::runtime_error("cannot start another process");
        if (process_ == 0) become_browser(name, profile, to_browser.read, from_browser.write);
        ::close(to_browser.read), ::close(from_browser.write);
        output_ = to_browser.write, input_ = from_browser.read;
    }
    ~Connection() {
        ::close(output_), ::close(input_);
        ::kill(-process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    Json call(const std::string& method, const Json& parameters = Json::object()) {
        Json message = {{"id", ++last_id_}, {"method", method}, {"params", parameters}};
        if (!session_.empty()) message["sessionId"] = session_;
        const std::string text = message.dump() + '\0';
        for (std::size_t done = 0; done < text.size();) {
            const ssize_t count = ::write(output_, text.data() + done, text.size() - done);
            if (count <= 0) throw std::runtime_error("Chromium does not listen any more");
            done += static_cast<std::size_t>(count);
        }
        while (true) {
            const Json answer = receive();
            if (answer.value("id", 0) != last_id_) continue;
            if (answer.contains("error"))
                throw std::runtime_error(fmt::format("{}: {}", method, answer["error"].dump()));
            return answer["result"];
        }
    }

    void use_new_tab() {
        const std::string before = std::exchange(target_, "");
        session_.clear();
        target_ = call("Target.createTarget", {{"url", "about:blank"}})["targetId"];
        session_ = call("Target.attachToTarget", {{"targetId", target_}, {"flatten", true}})["sessionId"];
        if (!before.empty()) call("Target.closeTarget", {{"targetId", before}});
        for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(fmt::format("{}.enable", domain));
        errors.clear(), requests.clear();
    }

    std::vector<std::string> errors, requests;

private:
    Json receive() {
        while (true) {
            const auto end = received_.find('\0');
            if (end != std::string::npos) {
                Json message = Json::parse(received_.substr(0, end));
                received_.erase(0, end + 1);
                note(message);
                return message;
            }
            pollfd waiting{input_, POLLIN, 0};
            if (::poll(&waiting, 1, patience_ms) <= 0) throw std::runtime_error("Chromium does not answer");
            std::array<char, 65536> buffer;
            const ssize_t count = ::read(input_, buffer.data(), buffer.size());
            if (count <= 0) throw std::runtime_error("Chromium ended");
            received_.append(buffer.data(), static_cast<std::size_t>(count));
        }
    }

    void note(const Json& message) {
        const std::string method = message.value("method", "");
        if (method.empty()) return;
        const Json& parameters = message["params"];
        if (method == "Runtime.exceptionThrown") {
            const Json& details = parameters["exceptionDetails"];
            const Json thrown = details.value("exception", Json::object());
            errors.push_back(thrown.value("description", details.value("text", "an exception")));
        }
        const std::string type = parameters.value("type", "");
        if (method == "Runtime.consoleAPICalled" && (type == "error" || type == "warning"))
            errors.push_back(parameters["args"].dump());
        if (method == "Log.entryAdded") errors.push_back(parameters["entry"].value("text", ""));
        if (method == "Network.requestWillBeSent") requests.push_back(parameters["request"].value("url", ""));
    }

    pid_t process_ = -1;
    int input_ = -1, output_ = -1, last_id_ = 0;
    std::string received_, target_, session_;
};

std::string Browser::program() {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
        if (run_shell(fmt::format("command -v {}", name)).exit_code == 0) return name;
    }
    return "";
}

Browser::Browser(const std::filesystem::path& profile) : connection_(std::make_unique<Connection>(profile)) {}
Browser::~Browser() = default;

void Browser::open(const std::filesystem::path& page, const Screen& screen) {
    Connection& connection = *connection_;
    connection.use_new_tab();
    connection.call(
        "Emulation.setDeviceMetricsOverride",
        {{"width", screen.width}, {"height", screen.height}, {"deviceScaleFactor", 1}, {"mobile", screen.touch}});
    connection.call("Emulation.setTouchEmulationEnabled", {{"enabled", screen.touch}, {"maxTouchPoints", 2}});
    const std::string scheme = screen.dark ? "dark" : "light";
    connection.call("Emulation.setEmulatedMedia",
                    {{"features", Json::array({{{"name", "prefers-color-scheme"}, {"value", scheme}}})}});
    connection.call("Page.navigate", {{"url", fmt::format("file://{}", page.string())}});
    wait_for(
        "document.getElementById('script-errors')?.hidden === false || "
        "(document.documentElement?.dataset.ready === 'true' && !document.querySelector('[aria-busy]'))");
}

void Browser::wait_for(const std::string& expression) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!truth(expression)) {
        if (std::chrono::steady_clock::now() > end) throw std::runtime_error(fmt::format("never true: {}", expression));
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

std::string Browser::text(const std::string& expression) {
    const Json answer = connection_->call(
        "Runtime.evaluate", {{"expression", fmt::format("(async () => String(await ({})))()", expression)},
                             {"awaitPromise", true},
                             {"returnByValue", true}});
    if (answer.contains("exceptionDetails")) {
        throw std::runtime_error(fmt::format("{}: {}", expression, answer["exceptionDetails"].dump()));
    }
    return answer["result"].value("value", "");
}

double Browser::number(const std::string& expression) { return std::stod(text(expression)); }
bool Browser::truth(const std::string& expression) { return text(fmt::format("Boolean({})", expression)) == "true"; }
void Browser::run(const std::string& statements) { text(fmt::format("(() => {{ {} }})()", statements)); }

std::pair<double, double> Browser::place_of(const std::string& selector, double x, double y) {
    const std::string element = fmt::format("document.querySelector({})", Json(selector).dump());
    if (!truth(element)) throw std::runtime_error(fmt::format("the page has no '{}'", selector));
    run(element + ".scrollIntoView({block: 'center'})");
    const auto edge = [&](const char* name) {
        return number(fmt::format("{}.getBoundingClientRect().{}", element, name));
    };
    return {edge("left") + x * edge("width"), edge("top") + y * edge("height")};
}

void Browser::mouse(const std::string& type, std::pair<double, double> place, double wheel) {
    if (type == "mousePressed") pressed_ = true;
    if (type == "mouseReleased") pressed_ = false;
    const bool with_button = pressed_ || type == "mouseReleased";
    connection_->call("Input.dispatchMouseEvent", {{"type", type},
                                                   {"x", place.first},
                                                   {"y", place.second},
                                                   {"button", with_button ? "left" : "none"},
                                                   {"buttons", pressed_ ? 1 : 0},
                                                   {"clickCount", type == "mouseMoved" || type == "mouseWheel" ? 0 : 1},
                                                   {"deltaX", 0},
                                                   {"deltaY", wheel}});
}

void Browser::move_to(const std::string& selector, double x, double y) {
    mouse("mouseMoved", place_of(selector, x, y));
}

void Browser::click(const std::string& selector, double x, double y) {
    const auto place = place_of(selector, x, y);
    for (const char* type : {"mouseMoved", "mousePressed", "mouseReleased"}) mouse(type, place);
}

void Browser::drag(const std::string& selector, std::pair<double, double> from, std::pair<double, double> to) {
    const auto start = place_of(selector, from.first, from.second), end = place_of(selector, to.first, to.second);
    mouse("mouseMoved", start);
    mouse("mousePressed", start);
    mouse("mouseMoved", {(start.first + end.first) / 2, (start.second + end.second) / 2});
    mouse("mouseMoved", end);
    mouse("mouseReleased", end);
}

void Browser::turn_wheel(const std::string& selector, double x, double y, double delta) {
    mouse("mouseWheel", place_of(selector, x, y), delta);
}

void Browser::pinch(const std::string& selector, double before, double after) {
    const auto fingers = [&](double apart) {
        Json points = Json::array();
        for (const int finger : {0, 1}) {
            const auto [x, y] = place_of(selector, 0.5 + (finger - 0.5) * apart, 0.5);
            points.push_back({{"x", x}, {"y", y}, {"id", finger}});
        }
        return points;
    };
    connection_->call("Input.dispatchTouchEvent", {{"type", "touchStart"}, {"touchPoints", fingers(before)}});
    for (const double done : {0.25, 0.5, 0.75, 1.0}) {
        const double apart = before + done * (after - before);
        connection_->call("Input.dispatchTouchEvent", {{"type", "touchMove"}, {"touchPoints", fingers(apart)}});
    }
    connection_->call("Input.dispatchTouchEvent", {{"type", "touchEnd"}, {"touchPoints", Json::array()}});
}

void Browser::press(const std::string& key, bool shift) {
    Json event = parse_key(key);
    event["modifiers"] = shift ? 8 : 0;
    event["type"] = "keyDown";
    connection_->call("Input.dispatchKeyEvent", event);
    event["type"] = "keyUp";
    event.erase("text");
    connection_->call("Input.dispatchKeyEvent", event);
}

void Browser::choose(const std::string& selector, const std::string& option) {
    run(fmt::format("const box = document.querySelector({}); box.value = {}; box.dispatchEvent(new Event('change'));",
                    Json(selector).dump(), Json(option).dump()));
}

void Browser::write_screenshot(const std::filesystem::path& png, bool whole_page) {
    const Json answer = connection_->call("Page.captureScreenshot", {{"captureBeyondViewport", whole_page}});
    std::filesystem::path text = png;
    text += ".base64";
    std::ofstream(text) << answer.value("data", "");
    run_shell(fmt::format("base64 --decode '{}' > '{}'", text.string(), png.string()));
    std::filesystem::remove(text);
}

const std::vector<std::string>& Browser::errors() {
    run("");  // what was told before this answer has arrived with it
    return connection_->errors;
}

const std::vector<std::string>& Browser::network_requests() {
    run("");
    return connection_->requests;
}

}  // namespace plumb
