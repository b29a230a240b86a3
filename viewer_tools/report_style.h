#pragma once

namespace rimod {

// The report's style sheet: light and dark by the reader's choice, wide tables scroll by
// themselves.
constexpr char kReportStyle[] = R"css(
:root { --text: #1d2126; --dim: #5a6470; --back: #ffffff; --card: #f1f3f6; --line: #cdd3da;
  --accent: #a2400c; --warn: #8a1f11; }
@media (prefers-color-scheme: dark) { :root { --text: #e4e7eb; --dim: #a2abb6; --back: #17191d;
  --card: #24282e; --line: #3b424b; --accent: #f2a365; --warn: #ff9d8f; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); background: var(--back);
  max-width: 1460px; margin: 0 auto; padding: 1rem 1.5rem; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.25rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 0; }
.cards { display: flex; flex-wrap: wrap; gap: .6rem; margin: 1rem 0; }
.card { background: var(--card); border-radius: 6px; padding: .5rem .9rem; display: flex;
  flex-direction: column; }
.card b { font-size: 1.3rem; } .card span, .scan, figcaption { color: var(--dim); font-weight: 400; }
.cause { color: var(--accent); }
.warning { color: var(--warn); }
.zero { color: var(--dim); }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; overflow-wrap: normal; }
th, td { border: 1px solid var(--line); padding: .2rem .6rem; text-align: left; }
th { background: var(--card); font-weight: 600; }
td { font-variant-numeric: tabular-nums; }
article { background: var(--card); border-radius: 6px; padding: .7rem .9rem; margin: .8rem 0; }
article p { margin: .2rem 0 .5rem; }
img { max-width: 100%; height: auto; display: block; margin: .4rem 0; border-radius: 4px; }
details { border: 1px solid var(--line); border-radius: 6px; padding: .4rem .8rem; margin: .4rem 0; }
summary { cursor: pointer; font-weight: 600; }
svg.plot { width: 100%; height: auto; max-width: 1100px; }
svg.bar { width: 200px; height: 12px; }
svg text { fill: var(--text); font-size: 13px; }
svg .grid { stroke: var(--line); }
.s0 { fill: #4e79a7; } .s1 { fill: #f28e2b; } .s2 { fill: #59a14f; } .s3 { fill: #e15759; }
.s4 { fill: #76b7b2; } .s5 { fill: #edc948; } .s6 { fill: #b07aa1; } .s7 { fill: #ff9da7; }
.s8 { fill: #9c755f; } .s9 { fill: #8f8a86; } .s10 { fill: #2f9ec4; } .s11 { fill: #b8c14a; }
)css";

}  // namespace rimod
