#!/usr/bin/env python3
"""What more nodes bring: model.py

A generation by ranks takes: the search's own part, which every rank repeats; the evaluations; the messages. The costs
are measured on two cores (MEASURED, README.md has the commands), the network is a published one. The model first
predicts what two ranks took here, then simulates 1 to 64 nodes of 64 cores, one rank each, event by event: who is free
takes a share of the rows, as the program does it. Evaluations take even times or, at random, 0.5 to 1.5 times the mean.
"""

import heapq
import math
import random

# Seconds of a generation of ga on one thread beside its evaluations (serial.py), and what of it stays on one thread:
# from one and two threads.
OWN = {1000: 0.6e-3, 10000: 7.0e-3, 100000: 82e-3}
ALONE = {1000: 0.55e-3, 10000: 6.2e-3, 100000: 68e-3}
# Designs of a generation, generations, seconds alone, of two at once, by two ranks: turns.py.
MEASURED = {"survey.toml": (197, 1, 9.96, 11.27, 5.76), "population.toml": (10000, 41, 1.53, 2.35, 1.63)}
# Packing, unpacking and hashing a row [s], and the rest of a generation's messages on one host: pkm_messages.
PER_ROW, PER_GENERATION = 60e-9, 3e-6
ROW_BYTES = 37
LATENCY, BANDWIDTH = 10e-6, 5e9  # s, bytes/s between nodes
CLAIM_HERE, CLAIM_THERE, ANSWER = 0.1e-6, 350e-6, 10e-6  # s: on a host; between hosts; what each keeps rank 0 busy


def chunks(count, threads):
    """Rows of each chunk, as chunks_of() in engine/problem/evaluator.cpp and share_pieces() have them."""
    while count > 0:
        chunk = max(1, count // (2 * threads))
        yield chunk
        count -= chunk


class Times:
    """How long the evaluations of chunks take."""

    def __init__(self, mean, even):
        self.mean, self.even, self.random = mean, even, random.Random(1)

    def of(self, rows):
        if self.even:
            return rows * self.mean
        if rows > 30:  # of many rows the sum is known well enough
            return self.mean * (rows + self.random.gauss(0, math.sqrt(rows / 12)))
        return sum(self.mean * (0.5 + self.random.random()) for _ in range(rows))


def claimed(count, threads, times, claim, answer=0.0):
    """When the last of the threads ends that claim chunks in turn, each claim taking so long."""
    free = [(0.0, thread) for thread in range(threads)]
    server = 0.0
    for rows in chunks(count, threads):
        now, thread = heapq.heappop(free)
        server = max(server, now) + answer  # one claim after the other
        heapq.heappush(free, (server + claim + times.of(rows), thread))
    return max(now for now, _ in free)


def evaluations(count, nodes, threads, mean, even):
    """All rows of a generation, by index or claimed, as the program decides after its first batch."""
    times = Times(mean, even)
    by_index = max(claimed((node + 1) * count // nodes - node * count // nodes, threads, times, CLAIM_HERE)
                   for node in range(nodes))
    share = count * mean / (nodes * threads)
    if nodes == 1 or not (share > 0.1 or by_index - share > max(0.05 * share, 1e-3)):
        return by_index
    return claimed(count, nodes * threads, times, CLAIM_THERE, ANSWER)


def own_part(population, threads):
    return ALONE[population] + (OWN[population] - ALONE[population]) / threads


def messages(count, nodes, latency=LATENCY, bandwidth=BANDWIDTH):
    """Two gathers (sizes, rows) and the decision of rank 0."""
    if nodes == 1:
        return 0.0
    rounds = math.ceil(math.log2(nodes))
    return 3 * rounds * latency + count * ROW_BYTES * (nodes - 1) / nodes / bandwidth + count * PER_ROW


def generation(population, nodes, threads, mean, even):
    return (own_part(population, threads) + evaluations(population, nodes, threads, mean, even) +
            messages(population, nodes))


def checks():
    """What two ranks of one thread took, both of which search, and slow each other down as two programs do."""
    for name, (count, generations, alone, at_once, measured) in MEASURED.items():
        own = OWN.get(count, 0.0)
        mean = (alone / generations - own) / count
        exchange = PER_GENERATION + count * PER_ROW
        predicted = at_once / alone * generations * (own + evaluations(count, 2, 1, mean, True) + exchange)
        print(f"{name:18} two ranks: predicted {predicted:5.2f} s, measured {measured:5.2f} s, "
              f"{100 * (predicted / measured - 1):+.0f} %")


def main():
    checks()
    print("\n| evaluation | population | " + " | ".join(f"{n} nodes" if n > 1 else "1 node" for n in NODES) +
          " | 90 % up to | times one node |")
    print("|---" * (len(NODES) + 4) + "|")
    for mean, name in ((2e-6, "2 us"), (0.5e-3, "0.5 ms"), (30e-3, "30 ms")):
        for population in OWN:
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
