// What the widgets of Bokeh do not do: files that are dropped, the colours of the system, a lost connection.
"use strict"
;(() => {
  const MOST_BYTES = 4e6 // larger ones the program refuses, too
  const model = (name) => Bokeh.documents[0].get_model_by_name(name)

  // A file in base 64, for the program
  function send(file) {
    if (!file) return
    const upload = model("upload")
    if (file.size > MOST_BYTES) {
      upload.data = {name: [file.name], content: [""], size: [file.size]}
      return
    }
    const reader = new FileReader()
    reader.addEventListener("load", () => {
      const content = reader.result.replace(/^[^,]*,/, "")
      upload.data = {name: [file.name], content: [content], size: [file.size]}
    })
    reader.readAsDataURL(file)
  }

  function start() {
    const [doc] = Bokeh.documents
    const field = document.getElementById("file")
    field.addEventListener("change", () => {
      send(field.files[0])
      // the same file may be given again
      field.value = ""
    })
    for (const event of ["dragover", "dragleave", "drop"]) {
      document.addEventListener(event, (dropped) => {
        dropped.preventDefault()
        document.body.classList.toggle("over", event === "dragover")
        if (event === "drop") send(dropped.dataTransfer.files[0])
      })
    }
    const scheme = matchMedia("(prefers-color-scheme: dark)")
    const paint = () => (model("scheme").data = {dark: [scheme.matches]})
    scheme.addEventListener("change", paint)
    if (scheme.matches) paint()
    const lost = document.getElementById("lost")
    doc.on_event("connection_lost", () => (lost.hidden = false))
    doc.on_event("client_reconnected", () => (lost.hidden = true))
    document.body.dataset.ready = "yes"
  }

  // the document of the session comes over the network of this machine
  const wait = setInterval(() => {
    if (!window.Bokeh || !Bokeh.documents.length || !model("upload")) return
    if (!Bokeh.documents[0].is_idle) return
    clearInterval(wait)
    start()
  }, 20)
})()
