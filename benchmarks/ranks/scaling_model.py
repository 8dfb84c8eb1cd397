#!/usr/bin/env python3
"""Performance model of runs on several nodes: scaling_model.py

The time of a generation consists of the search itself, which every rank repeats, the evaluations, and the messages. The
costs are measured on two cores (README.md lists the commands); latency and bandwidth of the network are published
values. The model first predicts the measured times of two ranks, and then runs a discrete-event simulation of 1 to 64
nodes of 64 cores with one rank each: an idle thread claims a chunk of rows, as in the program. Evaluations take equal
times, or random times of 0.5 to 1.5 times the mean.
"""

import heapq
import math
import random

# Seconds of a generation of `ga` without evaluations, by population: on one thread (overhead.py), and its serial part,
# which follows from the times on one and two threads.
SEARCH = {1000: 0.6e-3, 10000: 7.0e-3, 100000: 82e-3}
SERIAL = {1000: 0.55e-3, 10000: 6.2e-3, 100000: 68e-3}
# Designs of a generation, generations, seconds on one thread, of two concurrent processes, on two ranks: speedup.py.
MEASURED = {"survey.toml": (197, 1, 9.96, 11.27, 5.76), "population.toml": (10000, 41, 1.53, 2.35, 1.63)}
# Time of packing, unpacking and hashing a row, and fixed time of a generation's messages on one host [s]: pkm_messages.
PER_ROW, PER_GENERATION = 60e-9, 3e-6
ROW_BYTES = 37
LATENCY, BANDWIDTH = 10e-6, 5e9  # between nodes [s], [bytes/s]
# Claim of a chunk on a host and between hosts, and the time for which a claim between hosts occupies rank 0 [s].
CLAIM_LOCAL, CLAIM_REMOTE, ANSWER = 0.1e-6, 350e-6, 10e-6


def chunks(count, threads):
    """Yields the number of rows of each chunk, as chunks_of() in engine/problem/evaluator.cpp and parallel_for()."""
    while count > 0:
        chunk = max(1, count // (2 * threads))
        yield chunk
        count -= chunk


class Times:
    """Evaluation times of chunks."""

    def __init__(self, mean, even):
        self.mean, self.even, self.random = mean, even, random.Random(1)

    def chunk(self, rows):
        if self.even:
            return rows * self.mean
        if rows > 30:  # the sum of many rows is nearly normally distributed
            return self.mean * (rows + self.random.gauss(0, math.sqrt(rows / 12)))
        return sum(self.mean * (0.5 + self.random.random()) for _ in range(rows))


def finish_time(count, threads, times, claim, answer=0.0):
    """Returns the time at which the last thread finishes, if threads claim chunks dynamically.

    A claim takes `answer` + `claim`; the server answers one claim at a time, each in `answer`.
    """
    free = [(0.0, thread) for thread in range(threads)]
    server = 0.0
    for rows in chunks(count, threads):
        now, thread = heapq.heappop(free)
        server = max(server, now) + answer
        heapq.heappush(free, (server + claim + times.chunk(rows), thread))
    return max(now for now, _ in free)


def evaluations(count, nodes, threads, mean, even):
    """Time of all rows of a generation, shared by index or claimed dynamically, by the criterion of the program."""
    times = Times(mean, even)
    by_index = max(finish_time((node + 1) * count // nodes - node * count // nodes, threads, times, CLAIM_LOCAL)
                   for node in range(nodes))
    share = count * mean / (nodes * threads)
    if nodes == 1 or not (share > 0.1 or by_index - share > max(0.05 * share, 1e-3)):
        return by_index
    return finish_time(count, nodes * threads, times, CLAIM_REMOTE, ANSWER)


def search_time(population, threads):
    return SERIAL[population] + (SEARCH[population] - SERIAL[population]) / threads


def messages(count, nodes, latency=LATENCY, bandwidth=BANDWIDTH):
    """Time of the messages: two gathers (sizes, rows) and the broadcast of rank 0's decision."""
    if nodes == 1:
        return 0.0
    rounds = math.ceil(math.log2(nodes))
    return 3 * rounds * latency + count * ROW_BYTES * (nodes - 1) / nodes / bandwidth + count * PER_ROW


def generation(population, nodes, threads, mean, even):
    return (search_time(population, threads) + evaluations(population, nodes, threads, mean, even) +
            messages(population, nodes))


def compare_with_measurements():
    """Compares predictions with measurements of two ranks, which slow each other down like two concurrent processes."""
    for name, (count, generations, single, concurrent, measured) in MEASURED.items():
        search = SEARCH.get(count, 0.0)
        mean = (single / generations - search) / count
        exchange = PER_GENERATION + count * PER_ROW
        predicted = concurrent / single * generations * (search + evaluations(count, 2, 1, mean, True) + exchange)
        print(f"{name:18} two ranks: predicted {predicted:5.2f} s, measured {measured:5.2f} s, "
              f"{100 * (predicted / measured - 1):+.0f} %")


def main():
    compare_with_measurements()
    print("\n| evaluation | population | " + " | ".join(f"{n} nodes" if n > 1 else "1 node" for n in NODES) +
          " | 90 % up to | speedup over one node |")
    print("|---" * (len(NODES) + 4) + "|")
    for mean, name in ((2e-6, "2 us"), (0.5e-3, "0.5 ms"), (30e-3, "30 ms")):
        for population in SEARCH:
            kinds = [{n: generation(population, n, CORES, mean, even) for n in NODES} for even in (True, False)]
            efficient = [{n: population * mean / (n * CORES * times[n]) for n in NODES} for times in kinds]
            cells = " | ".join(" / ".join(percent(share[n]) for share in efficient) for n in NODES)
            enough = " / ".join(str(max((n for n in NODES if share[n] >= 0.9), default="never")) for share in efficient)
            gain = " / ".join(f"{times[1] / min(times.values()):.1f} on {min(NODES, key=times.get)}" for times in kinds)
            print(f"| {name} | {population} | {cells} | {enough} | {gain} |")


def percent(share):
    return f"{100 * share:.0f}" if share >= 0.095 else f"{100 * share:.1f}"


NODES, CORES = (1, 2, 4, 8, 16, 32, 64), 64

if __name__ == "__main__":
    main()
