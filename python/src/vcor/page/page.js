// Shows what `vcor page` has computed: looks numbers up, interpolates them, draws the curve and measured
// points. Nothing of an impact is computed here but the rebound height, e^2 times the height of the drop.
"use strict"
;(() => {
  const data = JSON.parse(document.getElementById("data").textContent)
  const get = (id) => document.getElementById(id)
  const STEPS = 240 // places of a slider, and of the curve
  const CUBIC = 4 // points of a cubic polynomial
  const MOST_BYTES = 4e6 // largest file of measurements
  const MOST_FAULTS = 5 // wrong lines that are shown
  const LEVELS = Object.keys(data.verdicts)

  // ------------------------------------------------------------------------------ table

  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))
  for (const table of data.tables) {
    const view = new DataView(bytes(table.cor).buffer)
    table.cor = Float32Array.from({length: view.byteLength / 4}, (_, i) => view.getFloat32(4 * i, true))
    table.state = bytes(table.state)
    table.cause = bytes(table.cause)
  }

  // All combinations of a value of each list
  const product = (lists) =>
    lists.reduce((found, list) => found.flatMap((one) => list.map((value) => [...one, value])), [[]])

  // Weights of the values at some points for that at a place: Lagrange's polynomials
  const lagrange = (points, place) =>
    points.map((point) =>
      points.reduce((made, other) => (other === point ? made : (made * (place - other)) / (point - other)), 1))

  // The number of a table at places 0 to count - 1 along each axis, as `Table.at` of table.py has it
  function at(table, places) {
    const counts = table.counts
    const index = (place) => place.reduce((found, one, k) => found * counts[k] + one, 0)
    const cells = places.map((place, k) => Math.min(Math.floor(place), counts[k] - 2))
    const exact = places.map((place) => Number.isInteger(place))
    const corners = places.map((place, k) => (exact[k] ? [place] : [cells[k], cells[k] + 1]))
    const near = product(corners).map(index)
    const states = [...new Set(near.map((node) => table.state[node]))]
    const causes = [...new Set(near.map((node) => table.cause[node]))]
    const around = near.map((node) => table.cor[node])
    if (states.length > 1) return {value: NaN, states, causes, around}
    const starts = places.map((place, k) => {
      if (exact[k]) return [[place]]
      const firsts = [0, -1, 1].map((shift) => Math.min(Math.max(cells[k] - 1 + shift, 0), counts[k] - CUBIC))
      return [...new Set(firsts)].map((first) => [0, 1, 2, 3].map((i) => first + i))
    })
    for (const points of [...product(starts), corners]) {
      const nodes = product(points).map(index)
      if (!nodes.every((node) => table.state[node] === states[0])) continue
      const weights = product(points.map((some, k) => lagrange(some, places[k])))
      const value = nodes.reduce(
        (sum, node, i) => sum + table.cor[node] * weights[i].reduce((one, other) => one * other, 1), 0)
      return {value, states, causes}
    }
  }

  // -------------------------------------------------------------------------------- axes

  const share = (axis, value) =>
    axis.log
      ? Math.log(value / axis.first) / Math.log(axis.last / axis.first)
      : (value - axis.first) / (axis.last - axis.first)
  const valueAt = (axis, part) =>
    part === 1
      ? axis.last
      : axis.log
        ? axis.first * (axis.last / axis.first) ** part
        : axis.first + (axis.last - axis.first) * part
  // A value at a place of the slider, with no more decimals than tell it from the next one
  function rounded(axis, step) {
    const value = valueAt(axis, step / STEPS)
    const apart = Math.abs(value - valueAt(axis, (step === STEPS ? step - 1 : step + 1) / STEPS))
    const made = Number(value.toFixed(Math.min(Math.max(Math.ceil(-Math.log10(apart)), 0), 15)))
    return Math.min(Math.max(made, axis.first), axis.last)
  }
  const text = (value, digits = 4) => String(Number(value.toPrecision(digits)))
  const withUnit = (axis, value) => `${text(value)} ${axis.unit}`.trim()

  // A place on the grid; one that only rounding keeps from a point is on it
  function placeOf(axis, count, value) {
    const place = share(axis, value) * (count - 1)
    const point = Math.round(place)
    const found = Math.abs(place - point) < 1e-9 * count ? point : place
    return Math.min(Math.max(found, 0), count - 1)
  }
  const placesOf = (table, values) => data.axes.map((axis, k) => placeOf(axis, table.counts[k], values[k]))

  // ------------------------------------------------------------------------------ inputs

  const state = {table: data.tables[0], values: data.axes.map((axis) => rounded(axis, STEPS / 2)), points: []}

  function element(kind, parent, properties = {}) {
    const made = Object.assign(document.createElement(kind), properties)
    parent.append(made)
    return made
  }

  function addChoice() {
    if (data.tables.length < 2) return
    const box = element("div", get("inputs"), {className: "input"})
    element("label", box, {htmlFor: "material", textContent: `Material of the ${data.body}`})
    const choice = element("select", box, {id: "material"})
    data.tables.forEach((table, i) => element("option", choice, {value: i, textContent: table.name}))
    choice.addEventListener("change", () => {
      state.table = data.tables[choice.value]
      show()
    })
  }

  function addInput(axis, k) {
    const box = element("div", get("inputs"), {className: "input"})
    const unit = axis.unit && ` [${axis.unit}]`
    element("label", box, {htmlFor: `number-${k}`, textContent: axis.label + unit, title: axis.address})
    const row = element("div", box, {className: "row"})
    const slider = element("input", row, {type: "range", id: `slider-${k}`, min: 0, max: STEPS, step: 1})
    slider.setAttribute("aria-label", axis.label)
    const number = element("input", row, {type: "number", id: `number-${k}`, step: "any"})
    const ends = element("div", box, {className: "ends"})
    element("span", ends, {textContent: withUnit(axis, axis.first)})
    element("span", ends, {textContent: withUnit(axis, axis.last)})
    const fault = element("p", box, {className: "fault", id: `fault-${k}`, role: "status"})

    function take(value) {
      fault.textContent = ""
      state.values[k] = value
      slider.setAttribute("aria-valuetext", withUnit(axis, value))
      show()
    }
    slider.addEventListener("input", () => {
      const value = rounded(axis, Number(slider.value))
      number.value = text(value, 6)
      take(value)
    })
    number.addEventListener("input", () => {
      const value = number.valueAsNumber
      if (!(value >= axis.first && value <= axis.last)) {
        const found = number.value === "" ? "no number" : number.value
        fault.textContent =
          `found ${found}, expected ${text(axis.first, 6)} to ${withUnit(axis, axis.last)}`
        return
      }
      slider.value = share(axis, value) * STEPS
      take(value)
    })
    slider.value = STEPS / 2
    number.value = text(state.values[k], 6)
    slider.setAttribute("aria-valuetext", withUnit(axis, state.values[k]))
  }

  // ------------------------------------------------------------------------------ answer

  // Decimals of e: those that the error of interpolation leaves
  const decimals = (error) =>
    error === null ? 3 : Math.min(Math.max(Math.floor(-Math.log10(2 * error + 1e-12)), 2), 5)

  function length(metres) {
    const [unit, size] = metres < 1e-3 ? ["µm", 1e-6] : metres < 0.01 ? ["mm", 1e-3] :
      metres < 1 ? ["cm", 1e-2] : ["m", 1]
    return `${text(metres / size, 3)} ${unit}`
  }

  function dropOf(table) {
    if (!("factor" in table.drop)) return NaN
    const axis = data.axes[table.drop.axis]
    if (!axis) return table.drop.factor
    const si = state.values[table.drop.axis] * axis.factor + axis.offset
    return table.drop.factor * si ** table.drop.power
  }

  function verdict(table, found) {
    const states = found.states.map((one) => table.states[one])
    const [status, level] = states[0]
    if (states.length > 1) {
      const isCounted = new Set(states.map(([, , contacts]) => contacts)).size > 1
      const kind = ([one, other, contacts]) =>
        (other === "none" ? one : other) + (isCounted ? ` with ${contacts} contacts` : "")
      const words = [...new Set(states.map(kind))]
      const [low, high] = [Math.min, Math.max].map((end) => end(...found.around.filter(Number.isFinite)))
      const near = `the nearest impacts have e = ${low.toFixed(4)} to ${high.toFixed(4)}`
      return ["", `No number between impacts of different kinds (${words.join(", ").replaceAll("_", " ")}); ${near}.`]
    }
    if (!Number.isFinite(found.value)) return ["", `No result: ${status.replaceAll("_", " ")}.`]
    if (level === LEVELS[0]) return [level, data.verdicts[level]]
    const causes = found.causes.map((one) => data.causes[one])
    const why = causes.map(([name, meaning]) => (meaning ? `${name} (${meaning})` : name))
    return [level, `${data.verdicts[level]}, by ${why.join(" or ")}.`]
  }

  function showAnswer() {
    const table = state.table
    const found = at(table, placesOf(table, state.values))
    const is = Number.isFinite(found.value)
    const [level, sentence] = verdict(table, found)
    get("e").textContent = is ? `e = ${found.value.toFixed(decimals(table.error))}` : "e = –"
    get("error").textContent =
      !is ? "" : table.error === null ? "error unknown" : `± ${table.error.toExponential(0)} by interpolation`
    const drop = dropOf(table)
    get("height").textContent =
      is && drop > 0 ? `Rebound height ${length(found.value ** 2 * drop)} of ${length(drop)}` : ""
    get("verdict").dataset.level = level
    get("level").textContent = level && `${level[0].toUpperCase()}${level.slice(1)}.`
    get("sentence").textContent = sentence
    get("beyond").replaceChildren()
    for (const line of table.beyond) element("li", get("beyond"), {textContent: line})
    get("said").textContent = `${table.name && `${table.name}: `}${table.said}.`
    get("case").textContent = table.case
    return found.value
  }

  // ------------------------------------------------------------------------------- curve

  const bokeh = (name) => Bokeh.documents[0].get_model_by_name(name)

  function curve() {
    const [axis] = data.axes
    const made = {x: []}
    for (const level of LEVELS) made[level] = []
    for (let i = 0; i <= STEPS; i++) {
      const x = valueAt(axis, i / STEPS)
      const found = at(state.table, placesOf(state.table, [x, ...state.values.slice(1)]))
      const level = state.table.states[found.states[0]][1]
      made.x.push(x)
      for (const one of LEVELS) made[one].push(one === level ? found.value : NaN)
    }
    return made
  }

  function showCurve(e) {
    const {points} = state
    bokeh("curve").data = curve()
    bokeh("here").data = {x: [state.values[0]], e: [e]}
    bokeh("points").data = {
      x: points.map((one) => one.x),
      e: points.map((one) => one.e),
      low: points.map((one) => one.e - one.bar),
      high: points.map((one) => one.e + one.bar),
    }
    get("legend").lastChild.hidden = points.length === 0
  }

  // The lines that the page can show, and measured points
  function addLegend() {
    const levels = new Set(data.tables.flatMap((table) => table.states.map(([, level]) => level)))
    for (const level of LEVELS.filter((one) => levels.has(one))) {
      element("li", get("legend"), {className: level, textContent: level})
    }
    element("li", get("legend"), {className: "points", textContent: "measured", hidden: true})
  }

  // Both axes hold all that the page can show, so that they stay while a slider moves
  function fitAxes() {
    let low = Infinity
    let high = -Infinity
    for (const table of data.tables)
      for (const value of table.cor)
        if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)]
    for (const {e, bar} of state.points) [low, high] = [Math.min(low, e - bar), Math.max(high, e + bar)]
    const margin = Math.max(0.08 * (high - low), 0.01)
    const [axis] = data.axes
    const xs = [axis.first, axis.last, ...state.points.map((one) => one.x).filter((x) => !axis.log || x > 0)]
    const set = (range, start, end) => Object.assign(range, {start, end, reset_start: start, reset_end: end})
    const {x_range, y_range} = bokeh("figure")
    set(y_range, low - margin, high + margin)
    set(x_range, Math.min(...xs), Math.max(...xs))
  }

  // Colours of the page, light or dark
  function paint() {
    const style = getComputedStyle(document.documentElement)
    const [page, words, line, blue, orange] = ["--page", "--text", "--line", "--curve", "--points"].map(
      (name) => style.getPropertyValue(name).trim())
    const plot = bokeh("figure")
    Object.assign(plot, {background_fill_color: page, border_fill_color: null, border_line_color: null, outline_line_color: line})
    for (const axis of [...plot.below, ...plot.left].filter((one) => "major_label_text_color" in one)) {
      for (const part of ["axis", "major_tick", "minor_tick"]) axis[`${part}_line_color`] = words
      for (const part of ["axis", "major"]) axis[`${part}_label_text_color`] = words
      axis.major_label_text_font_size = axis.axis_label_text_font_size = "14px"
      axis.axis_label_text_font_style = "normal"
    }
    for (const grid of plot.center.filter((one) => "grid_line_color" in one)) {
      Object.assign(grid, {grid_line_color: line, grid_line_alpha: 0.4})
    }
    for (const name of [...LEVELS, "place"]) bokeh(name).glyph.line_color = blue
    for (const name of ["measured", "bars"]) bokeh(name).glyph.line_color = orange
    bokeh("measured").glyph.fill_color = orange
  }

  function show() {
    showCurve(showAnswer())
  }

  // ------------------------------------------------------------------------ measurements

  // Measured points of a text, and what is wrong with its lines
  function parse(content) {
    const points = []
    const faults = []
    let isFirst = true
    const wanted = `expected ${data.axes[0].label}, e and the length of a bar or none`
    content.split(/\r\n|\r|\n/).forEach((line, i) => {
      const row = line.replace(/#.*/, "").trim()
      if (row === "") return
      const isEuropean = /[;\t]/.test(row) // a comma in it is that of a decimal number
      const cells = row.split(isEuropean ? /\s*[;\t]\s*/ : /\s*,\s*|\s+/).map((cell) => cell.trim())
      const numbers = cells.map((cell) => {
        const found = /^([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(%?)$/.exec(cell)
        return found ? Number(found[1].replace(",", ".")) / (found[2] ? 100 : 1) : NaN
      })
      const [x, e, bar = 0] = numbers
      const isHead = isFirst && numbers.every(Number.isNaN)
      isFirst = false
      if (isHead) return
      let fault = ""
      const wrong = numbers.findIndex((number) => !Number.isFinite(number))
      if (wrong >= 0) fault = `found '${cells[wrong].slice(0, 30)}', ${wanted}`
      else if (cells.length < 2 || cells.length > 3) fault = `found ${cells.length} numbers, ${wanted}`
      else if (e < 0 || e > 2) fault = `found e = ${e}, expected 0 to 2; a resilience is its square`
      else if (bar < 0) fault = `found a bar of ${bar}, expected a length`
      if (fault) faults.push(`line ${i + 1}: ${fault}`)
      else points.push({x, e, bar})
    })
    return {points, faults}
  }

  function measure() {
    const {points, faults} = parse(get("rows").value)
    state.points = points
    const shown = faults.slice(0, MOST_FAULTS)
    if (faults.length > MOST_FAULTS) shown.push(`and ${faults.length - MOST_FAULTS} more lines`)
    get("faults").replaceChildren()
    for (const line of shown) element("li", get("faults"), {textContent: line})
    fitAxes()
    show()
  }

  async function load(file) {
    if (!file) return
    if (file.size > MOST_BYTES) {
      get("faults").replaceChildren()
      element("li", get("faults"), {textContent: `${file.name}: found ${file.size} bytes, expected at most 4 MB`})
      return
    }
    get("rows").value = await file.text()
    measure()
  }

  function addMeasurements() {
    const [axis] = data.axes
    const unit = axis.unit && ` [${axis.unit}]`
    get("form").textContent =
      `One impact a line: ${axis.label}${unit}, e, and a bar if you like. They stay in this browser.`
    get("rows").addEventListener("input", measure)
    get("file").addEventListener("change", () => load(get("file").files[0]))
    get("clear").addEventListener("click", () => {
      get("rows").value = get("file").value = ""
      measure()
    })
    // a file that misses the field would replace the page
    for (const event of ["dragover", "dragleave", "drop"]) {
      document.addEventListener(event, (dropped) => {
        dropped.preventDefault()
        get("rows").classList.toggle("over", event === "dragover")
        if (event === "drop") load(dropped.dataTransfer.files[0])
      })
    }
  }

  // ------------------------------------------------------------------------------- start

  document.title = data.title
  get("title").textContent = data.title
  get("version").textContent = `Computed with vcor ${data.version}. This file needs no network.`
  addChoice()
  data.axes.forEach(addInput)
  addMeasurements()
  addLegend()
  Bokeh.embed.embed_item(data.figure, "figure").then(() => {
    paint()
    fitAxes()
    show()
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint)
    document.body.dataset.ready = "yes"
  })
  // what the tests ask for
  window.vcor = {at: (i, places) => at(data.tables[i], places).value}
})()
