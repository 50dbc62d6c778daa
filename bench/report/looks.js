// How curves look: one colour for each method or package, one mark and one dash for each way to solve its stages, in
// every figure.
export const looks = {
  "methods": {
    "imex-euler": "#E69F00",
    "implicit-euler": "#D55E00",
    "sbdf2": "#56B4E9",
    "bdf2": "#0072B2",
    "midpoint": "#009E73",
    "imex-midpoint": "#B79F00",
    "verlet": "#8C8C8C",
    "tr-bdf2": "#CC79A7",
    "esdirk3": "#A0522D",
    "esdirk4": "#AA4499",
    "bdf3": "#5B5BD6",
    "bdf4": "#2E8B8B",
    "bdf5": "#7B3F8C",
    "baraff-witkin": "#C0392B",
    "one-newton-bdf2": "#1B4F72",
    "ros2": "#117A65",
    "ros3p": "#7D6608",
    "rodas3": "#6E2C00",
    "ros34pw2": "#4A235A",
    "ros2-w": "#73C6B6",
    "cvode-bdf": "#C2185B",
    "cvode-adams": "#E57373",
    "arkode-dirk": "#6D4C41",
    "arkode-esdirk": "#F4511E",
    "arkode-imex": "#9E9D24",
    "arkode-erk": "#558B2F",
    "ida-bdf": "#607D8B",
    "ours": "#7A7A7A",
    "automatic": "#1F77B4",
    "explicit": "#009E73",
    "thesis": "#D62728",
    "SUNDIALS": "#AA4499"
  },
  "solvers": {
    "": ["circle", "solid"],
    "ic0": ["square", "dash"],
    "fixed-point/ic0": ["square", "dash"],
    "cholesky": ["cross", "dot"],
    "fixed-point/cholesky": ["square-open", "dashdot"],
    "anderson": ["triangle-up", "dot"],
    "newton": ["diamond", "dashdot"],
    "tension-newton": ["diamond-open", "dashdot"],
    "multigrid": ["star", "longdash"],
    "mic0": ["x", "longdash"]
  },
  "other_colours": ["#17BECF", "#BCBD22", "#E377C2", "#8D6E63", "#26A69A", "#EF6C00", "#5C6BC0", "#9CCC65"],
  "other_marks": [
    ["triangle-down", "dash"], ["pentagon", "dot"], ["hexagon", "dashdot"], ["star-diamond", "longdash"],
    ["hourglass", "dash"]
  ]
};
