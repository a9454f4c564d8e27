// Makes two run directories out of a good one: one with damage and hostile texts, one with a
// front of ten thousand.
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";

const [good, hostile, large] = process.argv.slice(2);
const front = JSON.parse(readFileSync(`${good}/front.json`, "utf8"));

const attack = "</script><script>window.attacked=1</script><img src=x onerror=window.attacked=1>";
mkdirSync(hostile, { recursive: true });
cpSync(`${good}/scenario.toml`, `${hostile}/scenario.toml`);
writeFileSync(`${hostile}/history.json`, "[{\"generation\": 1,");
const texts = structuredClone(front);
texts.version = attack;
texts.algorithm = attack;
texts.scenario.hash = attack;
texts.diagnostics = [{ code: "x", message: attack }];
texts.front = [
  texts.front[0],
  { ...texts.front[0], index: 2, chosen: false, design: { ...texts.front[0].design, notation: attack } },
  { index: "three" },
];
writeFileSync(`${hostile}/front.json`, JSON.stringify(texts));

mkdirSync(large, { recursive: true });
cpSync(`${good}/scenario.toml`, `${large}/scenario.toml`);
cpSync(`${good}/history.json`, `${large}/history.json`);
const [member] = front.front;
const [first, second] = Object.keys(member.objectives);
const members = [];
for (let n = 0; n < 10000; n++) {
  const share = n / 9999;
  const inclination = 40 + Math.round(200000 * share) / 10000;
  members.push({ ...member, index: n + 1, chosen: n === 5000,
    design: { ...member.design, notation: `delta:${inclination}:300/15/1@900`, inclination_deg: inclination },
    objectives: { [first]: 1 + share, [second]: 3 - 2 * Math.sqrt(share) } });
}
writeFileSync(`${large}/front.json`, JSON.stringify({ ...front, front: members }));
