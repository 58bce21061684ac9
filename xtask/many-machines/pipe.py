#!/usr/bin/env python3
"""Answers a query file on the machines of a Spark cluster: each part of it goes through `cargo xtask query -`.

    cargo build --release -p xtask
    pip install pyspark==4.3.0                                   # needs Java 17
    xtask/many-machines/pipe.py QUERIES.jsonl ANSWERS             # two workers of one core each, on this machine
    xtask/many-machines/pipe.py --master spark://HOST:7077 QUERIES.jsonl ANSWERS

ANSWERS is a folder; its files, in the order of their names, hold what one process would have written, byte by byte. A line
that cannot be answered is answered by its error, with its number in the whole file. The query file and the program must be
where all workers see them.
"""

import argparse
import os
import subprocess
import sys
import threading
import time

CHUNK = 1 << 20


def cut(path, parts):
    """The bytes where parts of about one size begin and end, each after the end of a line."""
    size = os.path.getsize(path)
    ends = {0, size}
    with open(path, "rb") as file:
        for part in range(1, parts):
            file.seek(size * part // parts)
            file.readline()
            ends.add(file.tell())
    ends = sorted(ends)
    return list(zip(ends, ends[1:]))


def chunks(path, begin, end):
    """The bytes of a part."""
    with open(path, "rb") as file:
        file.seek(begin)
        while begin < end:
            chunk = file.read(min(CHUNK, end - begin))
            if not chunk:
                raise OSError(f"{path} was cut short while it was read")
            begin += len(chunk)
            yield chunk


def count(path, begin, end):
    """How many lines end in a part."""
    return sum(chunk.count(b"\n") for chunk in chunks(path, begin, end))


def answer(program, path, begin, end, first_line):
    """The answers to a part, one line after the other; `first_line` is the number of its first line in the file."""
    # As many processes run as there are cores, so that each is to use one. Meshes are named relative to the query file.
    process = subprocess.Popen(
        [program, "query", "--first-line", str(first_line), "-"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "RAYON_NUM_THREADS": "1"},
        cwd=os.path.dirname(path),
    )

    def feed():
        # Where the program ends early, its exit status says why.
        try:
            with process.stdin as stdin:
                for chunk in chunks(path, begin, end):
                    stdin.write(chunk)
        except BrokenPipeError:
            pass

    feeder = threading.Thread(target=feed, daemon=True)
    feeder.start()
    with process.stdout as answers:
        for line in answers:
            yield line.decode().rstrip("\n")
    feeder.join()
    # 1 says that some line got an error for an answer, which is an answer; all else is a failure, and Spark tries again.
    if process.wait() not in (0, 1):
        raise RuntimeError(f"{program} ended with status {process.returncode}")


def answers(spark, program, path, parts):
    """The answers to a query file, as a data set of lines in their order."""
    ranges = cut(path, parts)
    context = spark.sparkContext
    # A line's number is that of lines before it: counted first, on all workers.
    lines = context.parallelize(ranges, len(ranges)).map(lambda r: count(path, *r)).collect()
    first, jobs = 1, []
    for (begin, end), of_part in zip(ranges, lines):
        jobs.append((begin, end, first))
        first += of_part
    return context.parallelize(jobs, max(len(jobs), 1)).flatMap(lambda job: answer(program, path, *job))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("queries", help="a query file")
    parser.add_argument("answers", help="the folder to write; it must not exist")
    parser.add_argument("--master", default="local-cluster[2,1,1024]", help="the cluster; %(default)s if left out")
    parser.add_argument("--parts", type=int, default=8, help="into how many parts the file is cut; %(default)s if left out")
    here = os.path.dirname(os.path.abspath(__file__))
    program = os.path.join(here, "..", "..", "target", "release", "xtask")
    parser.add_argument("--program", default=program, help="the program of `cargo xtask`")
    given = parser.parse_args()
    if not os.access(given.program, os.X_OK):
        sys.exit(f"{given.program} is not there: cargo build --release -p xtask")

    # Workers are given the functions of this file by value.
    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    from pyspark.sql import SparkSession

    begin = time.monotonic()
    settings = {"spark.ui.enabled": "false", "spark.ui.showConsoleProgress": "false"}
    spark = SparkSession.builder.master(given.master).appName("queries").config(map=settings).getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    ready = time.monotonic()
    path, program = os.path.abspath(given.queries), os.path.abspath(given.program)
    answers(spark, program, path, given.parts).saveAsTextFile("file://" + os.path.abspath(given.answers))
    print(f"Spark: {ready - begin:.1f} s to start, {time.monotonic() - ready:.1f} s to answer", file=sys.stderr)
    spark.stop()


if __name__ == "__main__":
    main()
