#!/usr/bin/env bash
# memory.sh PROGRAM: a square sheet falls on a sphere that swings, once of 50 x 50 and once of 150 x 150 vertices. By what the bakes
# hold at most, a vertex costs less than 2.5 KB, and the sheet of 50 x 50 no more than 36 MB with the program
# (2040 bytes and 27 MB when this was written).
#   FRAMES=1-30  what is baked
set -euo pipefail
program=$1 frames=${FRAMES:-1-30}
command -v perl >/dev/null || { echo "memory: skipped: there is no perl"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "memory: $*" >&2; exit 1; }

# scene FOLDER N: shot.toml and what it reads.
scene() {
  mkdir -p "$1"
  perl -e '
    my ($folder, $n) = @ARGV;
    my ($rings, $segments, $radius, $side, $samples, $pi) = (24, 48, 0.25, 1.0, 40, 3.14159265358979);
    my @v;
    for my $r (0 .. $rings) { for my $s (0 .. $segments - 1) {
      my ($a, $b) = ($pi * $r / $rings, 2 * $pi * $s / $segments);
      next if ($r == 0 || $r == $rings) && $s > 0;
      push @v, [$radius * sin($a) * cos($b), $radius * cos($a), $radius * sin($a) * sin($b)];
    } }
    my $at = sub { my ($r, $s) = @_; $r == 0 ? 1 : $r == $rings ? scalar @v : 2 + ($r - 1) * $segments + $s % $segments };
    open my $body, ">", "$folder/body.obj" or die $!;
    printf $body "v %.7f %.7f %.7f\n", @$_ for @v;
    for my $r (0 .. $rings - 1) { for my $s (0 .. $segments - 1) {
      my ($a, $b, $c, $d) = ($at->($r, $s), $at->($r, $s + 1), $at->($r + 1, $s + 1), $at->($r + 1, $s));
      print $body "f $a $b $c\n" if $a != $b;
      print $body "f $a $c $d\n" if $c != $d;
    } }
    open my $cache, ">:raw", "$folder/body.pc2" or die $!;
    print $cache pack("Z12 l< l< f< f< l<", "POINTCACHE2", 1, scalar @v, 0, 1, $samples);
    for my $f (0 .. $samples - 1) {
      my $aside = 0.15 * sin(2 * $pi * $f / 24);
      print $cache pack("f<3", $$_[0] + $aside, $$_[1], $$_[2]) for @v;
    }
    open my $cloth, ">", "$folder/cloth.obj" or die $!;
    for my $i (0 .. $n - 1) { for my $j (0 .. $n - 1) {
      printf $cloth "v %.7f %.7f %.7f\n", $side * ($i / ($n - 1) - 0.5), $radius + 0.01, $side * ($j / ($n - 1) - 0.5);
    } }
    for my $i (0 .. $n - 2) { for my $j (1 .. $n - 1) {
      my $a = $i * $n + $j;
      printf $cloth "f %d %d %d\nf %d %d %d\n", $a, $a + 1, $a + $n + 1, $a, $a + $n + 1, $a + $n;
    } }
    open my $shot, ">", "$folder/shot.toml" or die $!;
    print $shot "[shot]\nframes = \"1-40\"\nfps = 24\npreroll = 0\n[primary.body]\nfile = \"body.pc2\"\ntopology = \"body.obj\"\n",
      "source_fps = 24\n[cloth.cloth]\nmesh = \"cloth.obj\"\nfabric = \"cotton\"\non = \"body\"\n[cache]\nformats = [\"abc\"]\n";
  ' "$1" "$2"
}

# peak N: bytes that the bake of a sheet held at most.
peak() {
  scene "$work/$1" "$1"
  "$program" bake "$work/$1/shot.toml" --out "$work/$1/bake" --frames "$frames" --threads 2 --progress none >"$work/log" 2>&1 ||
    { cat "$work/log" >&2; fail "the bake of $1 x $1 vertices failed"; }
  "$program" check "$work/$1/bake" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the bake of $1 x $1 vertices crosses something"; }
  sed -n 's/.*"peak_memory_bytes": *\([0-9]\+\).*/\1/p' "$work/$1/bake/report.json" | grep . || fail "the report has no peak of memory"
}

small=$(peak 50)
large=$(peak 150)
each=$(((large - small) / (150 * 150 - 50 * 50)))
echo "memory: $small and $large bytes, $each a vertex"
[ "$each" -lt 2560 ] || fail "a vertex costs $each bytes, 2559 at most are promised; heaptrack shows what holds them"
[ "$small" -lt 36000000 ] || fail "the small sheet costs $small bytes"
