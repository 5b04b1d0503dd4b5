// Rules for the scripts of report pages, which run as they are in every browser with WebGL 2.
const names = [
  "Blob", "DecompressionStream", "ResizeObserver", "Response", "atob", "devicePixelRatio",
  "document", "matchMedia", "performance", "requestAnimationFrame",
];

export default [
  {
    files: ["meshlab_willmore/report/parts/*.js"],
    languageOptions: {
      ecmaVersion: 2022,
      sourceType: "module",
      globals: Object.fromEntries(names.map((name) => [name, "readonly"])),
    },
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      "array-callback-return": "error",
      "consistent-return": "off",
      eqeqeq: "error",
      "max-len": ["error", 100],
      "max-lines": ["error", 300],
      "no-const-assign": "error",
      "no-dupe-keys": "error",
      "no-eval": "error",
      "no-implied-eval": "error",
      "no-redeclare": "error",
      "no-shadow": "error",
      "no-undef": "error",
      "no-unreachable": "error",
      "no-unsafe-finally": "error",
      "no-unused-vars": "error",
      "no-use-before-define": ["error", { functions: false, variables: false }],
      "no-var": "error",
      "prefer-const": "error",
    },
  },
];
