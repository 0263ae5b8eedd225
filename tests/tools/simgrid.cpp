// simgrid PLATFORM TASKS: what SimGrid says that the tasks of synthetic.c take on a platform of duite-predict. A core takes the
// oldest ready task of its host; values go from one host to another one after the other, each once.
#include <cstdio>
#include <deque>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <simgrid/s4u.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace sg4 = simgrid::s4u;

namespace {

constexpr double flops = 1e9; // of a core of speed 1
constexpr double enough = 1e15;

struct place {
    int up = -1, cores = 1;
    double speed = 1, latency = 0, bandwidth = enough, capacity = enough;
    sg4::Link *out = nullptr, *in = nullptr, *through = nullptr;
};

std::vector<place> hosts, inner;

void read_platform(const char *path)
{
    std::map<std::string, int> names;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string what, first, word, value;
        if (!(words >> what >> first))
            continue;
        place p;
        while (words >> word >> value)
            if (word == "to")
                p.up = names.at(value);
            else if (word == "cores")
                p.cores = std::stoi(value);
            else
                (word == "speed"       ? p.speed
                 : word == "latency"   ? p.latency
                 : word == "bandwidth" ? p.bandwidth
                                       : p.capacity) = std::stod(value);
        if (what == "switch") {
            names[first] = static_cast<int>(inner.size());
            inner.push_back(p);
        } else {
            hosts.insert(hosts.end(), std::stoul(first), p);
        }
    }
}

std::vector<sg4::Host *> machine;

std::vector<place *> way_up(place *p)
{
    std::vector<place *> way{p};
    for (int up = p->up; up >= 0; up = inner[static_cast<size_t>(up)].up)
        way.push_back(&inner[static_cast<size_t>(up)]);
    return way;
}

std::vector<sg4::LinkInRoute> route(size_t from, size_t to)
{
    auto up = way_up(&hosts[from]), down = way_up(&hosts[to]);
    while (up.size() > 1 && down.size() > 1 && up[up.size() - 2] == down[down.size() - 2]) {
        up.pop_back();
        down.pop_back();
    }
    std::vector<sg4::LinkInRoute> links;
    for (size_t i = 0; i + 1 < up.size(); i++) {
        links.emplace_back(up[i]->out);
        links.emplace_back(up[i + 1]->through);
    }
    for (size_t i = down.size() - 1; i-- > 0;) {
        links.emplace_back(down[i]->in);
        if (i)
            links.emplace_back(down[i]->through);
    }
    return links;
}

void make_platform()
{
    auto *zone = sg4::create_full_zone("all");
    int n = 0;
    for (auto *list : {&hosts, &inner})
        for (auto &p : *list) {
            const std::string name = std::to_string(n++);
            p.out = zone->create_link("out" + name, p.bandwidth)->set_latency(p.latency)->seal();
            p.in = zone->create_link("in" + name, p.bandwidth)->set_latency(p.latency)->seal();
            p.through = zone->create_link("through" + name, p.capacity)->set_latency(0)->seal();
        }
    for (size_t h = 0; h < hosts.size(); h++) {
        auto *host = zone->create_host("host" + std::to_string(h), flops * hosts[h].speed);
        machine.push_back(host->set_core_count(hosts[h].cores)->seal());
    }
    for (size_t a = 0; a < hosts.size(); a++)
        for (size_t b = 0; b < hosts.size(); b++)
            if (a != b)
                zone->add_route(machine[a]->get_netpoint(), machine[b]->get_netpoint(), nullptr, nullptr, route(a, b), false);
    zone->seal();
}

struct task {
    size_t host;
    double seconds;
    uint64_t bytes;
    size_t pending;
    std::vector<size_t> readers;
};

std::vector<task> tasks;
std::vector<std::deque<size_t>> ready; // by host
std::map<std::pair<size_t, size_t>, std::deque<size_t>> waiting; // values, by sender and receiver
std::vector<sg4::SemaphorePtr> signal_of;                         // by host: tasks are ready
std::map<std::pair<size_t, size_t>, sg4::SemaphorePtr> posts;     // values wait
double last = 0;

void read_tasks(const char *path)
{
    std::ifstream file(path);
    task t{};
    for (size_t n = 0; file >> t.host >> t.seconds >> t.bytes >> n;) {
        t.pending = n;
        const size_t number = tasks.size();
        for (size_t k = 0, before; k < n && file >> before; k++)
            tasks[before].readers.push_back(number);
        tasks.push_back(t);
    }
}

// The value of a task is on a host.
void arrive(size_t number, size_t host)
{
    for (const size_t reader : tasks[number].readers)
        if (tasks[reader].host == host && !--tasks[reader].pending) {
            ready[host].push_back(reader);
            signal_of[host]->release();
        }
}

void core(size_t host)
{
    for (;;) {
        signal_of[host]->acquire();
        const size_t number = ready[host].front();
        ready[host].pop_front();
        sg4::this_actor::execute(flops * tasks[number].seconds);
        last = sg4::Engine::get_clock();
        std::set<size_t> others;
        for (const size_t reader : tasks[number].readers)
            others.insert(tasks[reader].host);
        arrive(number, host);
        others.erase(host);
        for (const size_t other : others) {
            waiting[{host, other}].push_back(number);
            posts[{host, other}]->release();
        }
    }
}

void post(size_t from, size_t to)
{
    for (;;) {
        posts[{from, to}]->acquire();
        const size_t number = waiting[{from, to}].front();
        waiting[{from, to}].pop_front();
        sg4::Comm::sendto(machine[from], machine[to], tasks[number].bytes);
        arrive(number, to);
    }
}

} // namespace

int main(int argc, char **argv)
{
    sg4::Engine engine(&argc, argv);
    // Plain sharing of bandwidth: no corrections for TCP, and none for traffic the other way.
    sg4::Engine::set_config("network/model:CM02");
    sg4::Engine::set_config("network/crosstraffic:0");
    if (argc != 3)
        return 2;
    read_platform(argv[1]);
    read_tasks(argv[2]);
    make_platform();
    ready.resize(hosts.size());
    for (size_t h = 0; h < hosts.size(); h++)
        signal_of.push_back(sg4::Semaphore::create(0));
    for (size_t i = 0; i < tasks.size(); i++)
        if (!tasks[i].pending) {
            ready[tasks[i].host].push_back(i);
            signal_of[tasks[i].host]->release();
        }
    for (size_t h = 0; h < hosts.size(); h++) {
        for (int c = 0; c < hosts[h].cores; c++)
            sg4::Actor::create("core", machine[h], core, h)->daemonize();
        for (size_t other = 0; other < hosts.size(); other++)
            if (other != h) {
                posts[{h, other}] = sg4::Semaphore::create(0);
                sg4::Actor::create("post", machine[h], post, h, other)->daemonize();
            }
    }
    sg4::Actor::create("clock", machine[0], [] {
        for (double before = -1; before < last; sg4::this_actor::sleep_for(1))
            before = last;
    });
    engine.run();
    std::printf("%.9f\n", last);
    return 0;
}
