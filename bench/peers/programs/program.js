// What programs for node share: node SCRIPT PEERS FOLDER, where PEERS has the folder node_modules that npm has filled.
// Reads FOLDER/problem.json and writes FOLDER/motion.json, as bench/peers/problem.hpp says.

const fs = require("node:fs");
const path = require("node:path");
const {pathToFileURL} = require("node:url");

const [peers, folder] = process.argv.slice(2);

/** The version of a package of npm, and what a file of it exports. */
async function load(name, file) {
  const root = path.join(peers, "node_modules", name);
  const {version} = JSON.parse(fs.readFileSync(path.join(root, "package.json"), "utf8"));
  return {version, exported: await import(pathToFileURL(path.join(root, file)))};
}

/**
 * Takes all steps, of which only the time is added, and a frame where one is asked for: frame() gives [positions,
 * velocities].
 */
function solve(problem, simulator, step, frame) {
  const solved = {simulator, seconds: 0, positions: [], velocities: []};
  let done = 0;
  for (const until of problem.steps) {
    const begin = process.hrtime.bigint();
    for (; done < until; ++done) step();
    solved.seconds += Number(process.hrtime.bigint() - begin) * 1e-9;
    const [positions, velocities] = frame();
    solved.positions.push(positions);
    solved.velocities.push(velocities);
  }
  return solved;
}

/** What fails is said in one line. */
async function main(run) {
  try {
    const problem = JSON.parse(fs.readFileSync(path.join(folder, "problem.json"), "utf8"));
    fs.writeFileSync(path.join(folder, "motion.json"), JSON.stringify(await run(problem)));
    process.exit(0);  // what a package has left running does not matter
  } catch (error) {
    console.error(String(error.message ?? error));
    process.exit(1);
  }
}

module.exports = {
  load,
  main,
  solve
};
